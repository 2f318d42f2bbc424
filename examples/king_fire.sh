#!/usr/bin/env bash
# From a fresh checkout to a film of the King Fire: sets up, writes the sample run, draws its maps and renders
# king_fire.toml. Takes half an hour on two cores the first time; run again, it does only what is missing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

./sample.sh
firetwin=../.venv/bin/firetwin
out=out

say() { echo "king_fire: $*" >&2; }

"$firetwin" info "$out/sample" >"$out/info.txt"
cat "$out/info.txt" >&2
if [[ ! -f $out/maps/intensity.png || $out/sample/run.toml -nt $out/maps/intensity.png ]]; then
  "$firetwin" maps "$out/sample" --out "$out/maps" >/dev/null
fi
say "rendering king_fire.toml; what is finished already is kept"
"$firetwin" render king_fire.toml --out "$out/film" --resume
if [[ ! -f $out/king_fire.blend || king_fire.toml -nt $out/king_fire.blend ]]; then
  "$firetwin" build king_fire.toml -o "$out/king_fire.blend" >/dev/null
fi

here=$PWD/$out
cat <<END

The King Fire, 17 September 2014, from a synthetic sample run:
  films          $here/film/drone/drone_rgb.mp4
                 $here/film/drone/drone_thermal.mp4
  pictures       $here/film/drone/{rgb,thermal}/
  depth          $here/film/drone/depth/  (EXR, metres)
  satellite      $here/film/satellite/rgb/ and thermal/
  maps           $here/maps/fuel.png, intensity.png
  facts          $here/info.txt
  scene          $here/king_fire.blend
  manifest       $here/film/manifest.json
END
