#!/usr/bin/env bash
# From a fresh checkout to a film of the King Fire: sets up, writes the sample run, draws its maps, and renders the first 24
# frames of the drone in king_fire.toml and its satellite picture, in 10 minutes on two cores. A second run renders only missing
# files. With --still it ends after the first picture; with --all it renders all 48 frames, which takes about twice as long.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

still=false frames=1-24
for argument in "$@"; do
  case $argument in
    --still) still=true ;;
    --all) frames=1-48 ;;
    *)
      echo "usage: examples/king_fire.sh [--still] [--all]" >&2
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

maps=
if [[ ! -f $out/maps/intensity.png || $out/sample/run.toml -nt $out/maps/intensity.png ]]; then
  "$firetwin" maps "$out/sample" --out "$out/maps" >/dev/null &
  maps=$!
fi
"$firetwin" info "$out/sample" >"$out/info.txt"
cat "$out/info.txt" >&2
say "rendering the missing pictures of king_fire.toml"
"$firetwin" render king_fire.toml --out "$out/film" --camera drone --frames "$frames" --resume >/dev/null
"$firetwin" render king_fire.toml --out "$out/film" --camera satellite --resume
if [[ -n $maps ]]; then
  wait "$maps"
fi
if [[ ! -f $out/king_fire.blend || king_fire.toml -nt $out/king_fire.blend ]]; then
  say "the film is finished: $here/film/drone/drone_rgb.mp4"
  say "writing the scene as a .blend file, without its smoke volumes"
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

Smoke in the .blend file: choose Firetwin > Scene > Smoke of frames in Blender, or run
  .venv/bin/firetwin bake --volumes examples/king_fire.toml
All 48 frames: examples/king_fire.sh --all
END
