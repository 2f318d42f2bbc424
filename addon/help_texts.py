"""Long help texts of the command line."""

EPILOG = """\
a first film, from the sample run:
  firetwin sample sample                 writes the sample run (synthetic, King-like)
  firetwin info sample                   lists its content
  firetwin render examples/king_fire.toml --out film --resume

a film of your own run:
  firetwin render RUN --out film         fits cameras and times to the fire, and prints them
  firetwin new RUN -o my_scene.toml      writes them to a short scene file that you can edit
  firetwin render my_scene.toml --out film

`firetwin COMMAND --help` explains a command."""

SAMPLE = """\
No output of a fire-atmosphere model for the King Fire is public. This run is synthetic: terrain, fuels and
spread follow publications about the fire. All its output is labelled as synthetic."""

ASSETS = """\
Writes DIR/firetwin_assets.blend and DIR/blender_assets.cats.txt for Blender's asset browser. Add DIR under
Edit > Preferences > File Paths > Asset Libraries. Light, haze and temperatures are taken from the scene
file."""

INFO = """\
Lists grid, extent, fuels, times, heat flux, energy, burned area and warnings, and reported acreages if the
run depicts a known fire."""

CITE = """\
Lists software, algorithms, fire model, facts about the fire, and files of observations. For a scene file, it
also lists the credits of terrain, imagery and tiles, which their licences require. --crate writes
DIR/ro-crate-metadata.json: it describes the files of a film, its run, software and sources for an archive."""

CONVERT = """\
The format is detected from the content: WRF-SFIRE (wrfout*), NCAR's Community Fire Behavior Model
(fire_output_*.nc), ForeFire (arrival times, fronts, landscape), ELMFIRE (GeoTIFF), FARSITE and FlamMap
(ASCII or GeoTIFF, LCP), pyretechnics (.npz), and any CF netCDF with a mapping in a TOML file: [fields]
heat_flux = "NAME". Fuels can come from an LCP or from LANDFIRE rasters among the files. Values that the
model does not provide are assumed, printed and written to run.toml. One call converts one run; files of
several runs, models or places are rejected. Clocks show the time of --zone; without it, the UTC offset of
--start; without both, the offset by longitude, ignoring daylight saving time and borders. Repeating the
command resumes a stopped conversion. A conversion that reads and writes nothing for ten minutes is ended,
as the file is probably damaged. Needs optional packages: pip install 'firetwin[models]'."""

WATCH = """\
Polls the files of WRF-SFIRE, CFBM, or CF netCDF or zarr with a heat flux. It locks no file, so that the model
can go on writing. A time is complete when the model's log (rsl.error.0000) names it, or a later time exists.
Otherwise it is guessed: size and modification time of its file are equal in two polls.

DIR/times.json              accepted times: file, reason, hash of the values
DIR/status.json, index.html state: waiting, running, stalled, ended, failed or restarted
DIR/generation_1/000012     run of the first 12 times

Commands accept DIR as a run; its newest times are read. If the model starts again, generation_2 begins.
3D fields are not converted; use `convert` when the model has ended. Repeating the command continues a watch.
The exit status is 1 if the model failed."""

NEW = """\
Selects the most active part of the run, and fits cameras to the fire: an overview from upwind with the sun
behind it, a chase camera at the head, a close view of a flank, and a view from above. Each camera is moved
until at least half of its front is in the frustum and not occluded by terrain or dense smoke; the visible
share is printed. `render`, `build` and `bake` of RUN use the same settings."""

MAPS = """\
DIR/fuel.png        surface and canopy fuel together, kg/m2; greener is denser
DIR/intensity.png   maximum heat flux of the run, light yellow to red, over shaded relief"""

HAZE = """\
GRIB2 are files of HRRR (wrfsfc) with smoke: MASSDEN at 8 m and COLMD. Prints density, column mass, visual
range (only smoke, contrast of 2 %) and optical depth over the run at each valid time, and the lines of a
scene file for --time: light.smoke and light.smoke_height. Extinction is 4 m2/g; measured values are 3.3 to
7.4 m2/g. Fields of zeros are refused, as they are not clean air. Needs rasterio and pyproj."""

SCORE = """\
FILE holds dated perimeters (.geojson, .shp, .kml, .kmz, .gpkg) or FIRMS detections of VIIRS and MODIS
(.csv). Append the date to a file without dates: FILE@2014-09-18T04:00-07:00. Scores by date: areas, Sorensen,
Jaccard, kappa, precision, recall, shape deviation and area difference indices, and distances of the
perimeters, with and without the area burned before the start of the run. Further scores: errors of arrival
times, and detections with their lag. Each score is computed on polygons and on cells; their difference
estimates the numerical error of the score, not of the fire model. Observations outside the times or the grid
of the run are counted and ignored. The exit status is 1 if none remains. Needs shapely and pyproj (pip
install 'firetwin[score]'). For an ensemble: CRPS, Brier score, reliability and FSS."""

IMAGER = """\
Brightness temperatures (K) at 3.9 and 11.2 um (3.74 and 11.45 for viirs), fire radiative power (W) and a
mask of fire (10) and saturated (11) pixels, in DIR/abi_20140917T2200Z.tif. abi has a geostationary
projection and a ground sample distance of 2 km; viirs has a latitude-longitude grid and 375 m. Radiance is
weighted by the area of fire in a pixel. For the fire power, the detectors saturate at 400 K (abi, 3.9 um)
and 634 K (viirs, band M13, 750 m). The images are hypothetical: ABI was not yet in orbit in 2014, and
observations of VIIRS are not used. The passes imager_short and imager_long of a satellite camera show such
images. Needs rasterio (pip install 'firetwin[raster]')."""

BUILD = """\
The file can be opened, played and rendered without the add-on. Its smoke volumes are files in the cache
folder, about 50 MB per frame of the example. Without --volumes they are written later: by the add-on for
the frames that you choose, by the add-on before a frame is rendered in Blender, or by `bake --volumes`. A
frame without volumes says so in the picture. `render` does not need them.

--live adds the same shot in a form that 3D views and headsets draw fast, and shows it there. Renders always
show the film's scene. The collection "Firetwin Live" has the live scene."""

BAKE = """\
Without --volumes, `bake` does the work on smoke that `render` otherwise does: it solves the flow, or writes
the volumes of smoke that Blender draws. With --volumes it writes the volumes that a .blend file of `build`
shows; the file itself does not change."""

RENDER = """\
DIR/CAMERA/PASS/CAMERA_PASS_000001.png   and .exr, by pass
DIR/CAMERA/CAMERA_PASS.mp4               films, with the model time in each frame
DIR/manifest.json                        settings, versions, hashes of inputs and files

passes:
{passes}

Without --resume all selected frames are rendered again. Several renders, on one or more computers, can write
to one folder at the same time and divide the frames by leases. Start each with --resume and with the same
scene file, run, Firetwin and Blender.

--follow films a run that `watch` writes. A frame is rendered when the next model time exists, from the times
up to it, so that it equals the frame that --follow renders when the model has ended. Exposure is metered in
the first frame and kept. Cameras that follow the fire are an error. Films are replaced as a whole.

Before the first frame the expected memory is printed, if there is an estimate: for smoke solved as a flow
and ray marched, and for pictures without smoke. At the end --json prints expected and peak memory (bytes,
null if unknown), the number of pictures rendered by this command, and the files."""

TRACK = """\
One point per frame: WGS84 degrees, metres above sea level (the datum of the run's elevations) and model
time in UTC. A drone camera with track = "FILE.gpx" follows it. Flight planners and maps can read the file."""

CACHE = """\
Lists volumes and tiles of each shot with size and last use, most recent first, and then cached responses of
tile servers. --prune removes the least recently used until volumes and tiles fit into --limit, and responses
into --answers. Files in use by a bake or render are not removed."""

GPU = """\
Lists the GPUs that Cycles finds, whether their kernels are ready, and the kernel caches of the driver.
Blender ships kernels for many NVIDIA cards, but not for A100, H100, H200 and B200. For these the driver
compiles them at their first use, which takes 6 to 10 minutes. --warm compiles them in advance; run it once on
each machine of a farm. --kernels makes them with ptxas (Python package nvidia-cuda-nvcc-cu12) and saves them
in Blender's folder, which must be writable, as in a virtual environment. It needs no GPU."""

SCHEMA = """\
Save it, and refer to it in the first line of a scene file (`#:schema firetwin.json`). TOML editors then
complete keys, show their help and underline mistakes."""

BENCH = """\
Measures twelve steps and their alternatives in turn on this machine: median and range of at least five
repetitions. Takes about three CPU minutes. --runs 3 shows the variation between runs.
Alternatives that are not installed are listed and skipped (pip install 'firetwin[bench]' installs them).
The exit status is 1 if a target is missed."""
