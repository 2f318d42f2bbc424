"""Flamenco 3: a job type, which the Manager compiles to tasks, and the settings of the job."""

from __future__ import annotations

import json
import platform
import shlex
from pathlib import Path

from ... import files
from ...errors import UsageError
from ...shot.schema.frame_list import FrameList
from ._engine import Batch, Engine, firetwin_command

MANAGER = "http://localhost:8080"

JOB_TYPE = """\
// Flamenco job type of all Firetwin films: copy it into the folder "scripts" next to flamenco-manager.
const JOB_TYPE = {
  label: "Firetwin film",
  settings: [
    { key: "command", type: "string", required: true, description: "Command of Firetwin, a JSON list" },
    { key: "out", type: "string", required: true, description: "Folder of the film" },
    { key: "bakes", type: "string", default: "", description: "Numbers of the smoke tasks" },
    { key: "renders", type: "string", default: "", description: "Numbers of the render tasks" },
  ],
};

function compileJob(job) {
  const [exe, ...first] = JSON.parse(job.settings.command);

  function addTask(name, type, last, before) {
    const task = author.Task(name, type);
    task.addCommand(author.Command("exec", { exe: exe, args: first.concat(["farm"], last) }));
    before.forEach((each) => task.addDependency(each));
    job.addTask(task);
    return task;
  }

  function addStage(stage, numbers, before) {
    const listed = numbers ? frameChunker(numbers, 1) : [];
    return listed.map((number) =>
      addTask(stage + "-" + number, "blender", ["task", job.settings.out, number], before));
  }

  const bakes = addStage("bake", job.settings.bakes, []);
  const renders = addStage("render", job.settings.renders, bakes);
  addTask("assemble", "misc", ["assemble", job.settings.out], bakes.concat(renders));
}
"""

_SUBMIT = """\
#!/bin/bash
# Submits the job to a Flamenco Manager: submit.sh [ADDRESS [OPTIONS OF CURL]]
set -euo pipefail
cd {folder}
manager=${{1:-{manager}}}
call() {{ curl -fsS "${{@:2}}" "$manager/api/v3/jobs$1"; }}
if ! call /type/firetwin -o job_type.json "${{@:2}}"; then
  echo "$manager: no Firetwin job type; copy $PWD/firetwin.js into the Manager's folder scripts" >&2
  exit 1
fi
call "" -H 'Content-Type: application/json' --data @job.json -o submitted.json "${{@:2}}"
id=$(grep -o '"id": *"[^"]*"' submitted.json | head -n 1 | cut -d '"' -f 4)
echo "$manager/api/v3/jobs/$id" >jobs.txt
echo "submitted Flamenco job $id"
"""


class Flamenco(Engine):
    """One job type for all films; its settings have the task numbers."""

    name = "flamenco"
    help = "Flamenco 3: a job type, submitted with curl"

    def write(self, batch: Batch) -> list[str]:
        """Write the job type, the job and a script that submits it."""
        folder = self.folder(batch.out)
        files.write_text(folder / "firetwin.js", JOB_TYPE)
        files.write_text(folder / "job.json", json.dumps(_job(batch), indent=1) + "\n")
        submit = _SUBMIT.format(folder=shlex.quote(str(folder)), manager=MANAGER)
        files.write_text(folder / "submit.sh", submit)
        return ["bash", str(folder / "submit.sh"), *batch.options]

    def cancel(self, out: Path) -> list[str]:
        """Return the request that cancels the last submitted job."""
        jobs = self.folder(out) / "jobs.txt"
        if not jobs.exists():
            raise UsageError(f"{out}: no job was submitted to Flamenco from this folder")
        asked = json.dumps({"status": "cancel-requested", "reason": "firetwin farm cancel"})
        address = f"{files.read_text(jobs).strip()}/setstatus"
        return ["curl", "-fsS", "-H", "Content-Type: application/json", "--data", asked, address]


def _job(batch: Batch) -> dict[str, object]:
    """Describe the job for the API of the Manager."""
    return {
        "name": f"Firetwin {Path(batch.job.scene).stem}",
        "type": "firetwin",
        "priority": 50,
        "submitter_platform": platform.system().lower(),
        "settings": {
            "command": json.dumps(firetwin_command()),
            "out": str(batch.out),
            "bakes": FrameList.of(batch.stage("bake")),
            "renders": FrameList.of(batch.stage("render")),
        },
    }


ENGINE = Flamenco
