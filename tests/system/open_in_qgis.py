"""Open a project in QGIS and list its layers; a process of QGIS' own Python, called by test_export.py."""

import os
import sys

from qgis.core import QgsApplication, QgsProject

application = QgsApplication([], False)
application.initQgis()
project = QgsProject.instance()
read = project.read(sys.argv[1])
print("project", project.crs().authid() if read else "unreadable")
for key, layer in project.mapLayers().items():
    times = layer.temporalProperties()
    state = "dated" if times is not None and times.isActive() else "valid"
    print(key, state if layer.isValid() else "invalid")
sys.stdout.flush()
os._exit(0)  # QGIS crashes if Python ends it
