#!/usr/bin/env bash
# From a fresh checkout to a film of the King Fire: sets up, writes the sample run, draws its maps and renders
# king_fire.toml. The first run takes 12 minutes on two cores; a second run renders only missing files. With --still it ends
# after the first picture of the drone.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

still=false
for argument in "$@"; do
  case $argument in
    --still) still=true ;;
    *)
      echo "usage: examples/king_fire.sh [--still]" >&2
      exit 2
      ;;
  esac
done

./sample.sh
firetwin=../.venv/bin/firetwin
out=out
here=$PWD/$out

say() { echo "king_fire: $*" >&2; }

if [[ $still == true ]]; then
  say "rendering the first picture of king_fire.toml, unless it is finished"
  "$firetwin" render king_fire.toml --out "$out/film" --frames 1 --camera drone --resume >/dev/null
  say "the first picture; its depth and temperatures are in the same folder. Without --still the film is rendered"
  echo "$here/film/drone/rgb/drone_rgb_000001.png"
  exit
fi

"$firetwin" info "$out/sample" >"$out/info.txt"
cat "$out/info.txt" >&2
if [[ ! -f $out/maps/intensity.png || $out/sample/run.toml -nt $out/maps/intensity.png ]]; then
  "$firetwin" maps "$out/sample" --out "$out/maps" >/dev/null
fi
say "rendering the missing pictures of king_fire.toml"
"$firetwin" render king_fire.toml --out "$out/film" --resume
if [[ ! -f $out/king_fire.blend || king_fire.toml -nt $out/king_fire.blend ]]; then
  say "the film is finished: $here/film/drone/drone_rgb.mp4"
  say "writing the scene as a .blend file, with the smoke of all frames, which takes minutes"
  "$firetwin" build king_fire.toml -o "$out/king_fire.blend" >/dev/null
fi

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
