"""Read a job bundle as `deadline bundle submit` does; run by the Python of deadline's own environment.

    python read_bundle.py BUNDLE CACHE

Prints, as JSON, the parameters of the service and of the job, and of each root the files that would travel
and the folders that would come back. A bundle that would be refused raises deadline's own error.
"""

import json
import sys
from pathlib import Path

from deadline.client.job_bundle import loader, parameters, submission
from deadline.job_attachments.models import JobAttachmentS3Settings
from deadline.job_attachments.upload import S3AssetManager


def main(bundle: str, cache: str) -> None:
    """Resolve parameters and assets, and hash the assets."""
    loader.validate_directory_symlink_containment(bundle)
    loader.read_yaml_or_json(bundle, "template", required=True)
    listed = loader.read_yaml_or_json_object(bundle, "asset_references", required=False)
    assets = submission.AssetReferences.from_dict(listed)
    own = parameters.read_job_bundle_parameters(bundle)
    parameters.apply_job_parameters([], bundle, own, assets)
    service, job = submission.split_parameter_args(own, bundle)
    folders = [path for folder in assets.input_directories for path in Path(folder).rglob("*")]
    files = assets.input_filenames | {str(path) for path in folders if path.is_file()}
    manager = S3AssetManager(
        "farm", "queue", JobAttachmentS3Settings("bucket", "root"), asset_uploader=object()
    )
    lists = (sorted(each) for each in (files, assets.output_directories, assets.referenced_paths))
    found = manager.prepare_paths_for_upload(*lists, require_paths_exist=True)
    about = found.asset_groups, found.total_input_files, found.total_input_bytes
    _, manifests = manager.hash_assets_and_create_manifest(*about, hash_cache_dir=cache)
    roots = [
        {
            "root": each.root_path,
            "inputs": [path.path for path in each.asset_manifest.paths] if each.asset_manifest else [],
            "outputs": [str(path) for path in each.outputs],
        }
        for each in manifests
    ]
    print(json.dumps({"service": service, "job": job, "roots": roots}))


if __name__ == "__main__":
    main(*sys.argv[1:])
