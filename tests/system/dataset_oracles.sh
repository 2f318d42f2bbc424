#!/usr/bin/env bash
# Tests formats of data sets with the libraries that read them. They need 700 MB and NumPy 2, so they are installed in
# $FIRETWIN_CACHE/dataset_oracles (~/.cache/firetwin) and not in the virtual environment.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

folder=${FIRETWIN_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/firetwin}/dataset_oracles
if [[ ! -f $folder/complete ]]; then
  rm -rf "$folder"
  .venv/bin/python -m pip install -q --no-warn-conflicts --target "$folder" 'numpy>=2,<2.4' pycocotools==2.0.11 pycolmap==4.2.1 \
    mlcroissant==1.1.1 datasets==5.2.0 globox==2.9.0
  touch "$folder/complete"
fi
HF_HUB_OFFLINE=1 PYTHONPATH=$folder .venv/bin/python -m pytest -q -rs -p no:cacheprovider -o budget_factor=10 \
  tests/unit/dataset/test_dataset_oracles.py tests/unit/dataset/test_dataset_finish.py tests/unit/dataset/test_dataset_rle.py
