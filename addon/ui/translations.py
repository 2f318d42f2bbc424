"""Translations of the interface (`bpy.app.translations`): names of operators, panels and menus, in German.

Another language is another table with the same keys. Texts that a table does not have stay English.
"""

from __future__ import annotations

import bpy

GERMAN = {
    # operators
    "Build live scene": "Live-Szene erstellen",
    "Switch live scene": "Live-Szene umschalten",
    "Add VR landmarks": "VR-Landmarken hinzufügen",
    "Start or stop VR": "VR starten oder beenden",
    "Start VR at landmark": "VR an Landmarke starten",
    "Play or pause in VR": "In VR abspielen oder anhalten",
    "Move time in VR": "Zeit in VR bewegen",
    "Go to landmark in VR": "In VR zur Landmarke gehen",
    "Teleport in VR": "In VR teleportieren",
    "Turn in VR": "In VR drehen",
    "Start VR at": "VR starten an",
    "VR": "VR",
    "Measure viewport": "Ansicht messen",
    "Add Firetwin Regrade": "Firetwin Regrade hinzufügen",
    "Add camera from view": "Kamera aus Ansicht hinzufügen",
    "Add run to compare": "Vergleichslauf hinzufügen",
    "Build scene": "Szene bauen",
    "Cancel farm job": "Farm-Auftrag abbrechen",
    "Convert model output": "Modellausgabe umwandeln",
    "Copy camera": "Kamera kopieren",
    "Copy details of last message": "Einzelheiten der letzten Meldung kopieren",
    "Draw camera path": "Kamerapfad zeichnen",
    "Edit shot of story": "Einstellung der Geschichte bearbeiten",
    "Esc pauses the queue": "Esc hält die Warteschlange an",
    "Export": "Export",
    "Export for other programs": "Für andere Programme exportieren",
    "Export scene file": "Szenendatei exportieren",
    "F12 writes files": "F12 schreibt Dateien",
    "Go to place or time": "Zu Ort oder Zeit gehen",
    "Jump to time of the run": "Zu einer Zeit des Laufs springen",
    "Make or read story": "Geschichte erstellen oder lesen",
    "Move shot of story": "Einstellung der Geschichte verschieben",
    "Open manual": "Handbuch öffnen",
    "Open run": "Lauf öffnen",
    "Open story in Video Sequencer": "Geschichte im Videoschnitt öffnen",
    "Pause, resume or remove a render": "Rendern anhalten, fortsetzen oder entfernen",
    "Pick station on map": "Station auf der Karte wählen",
    "Point camera at": "Kamera ausrichten auf",
    "Preview tiles": "Kacheln ansehen",
    "Read farm status": "Stand der Farm lesen",
    "Read run": "Lauf lesen",
    "Remove camera": "Kamera entfernen",
    "Remove run": "Lauf entfernen",
    "Remove scene": "Szene entfernen",
    "Remove tile preview": "Kachelvorschau entfernen",
    "Render": "Rendern",
    "Render in background": "Im Hintergrund rendern",
    "Render story": "Geschichte rendern",
    "Reset settings to default": "Einstellungen zurücksetzen",
    "Resume farm job": "Farm-Auftrag fortsetzen",
    "Save settings as preset": "Einstellungen als Vorlage sichern",
    "Set camera key": "Kameraschlüssel setzen",
    "Set lens and sensor": "Objektiv und Sensor einstellen",
    "Set output preset": "Ausgabevorlage einstellen",
    "Set quality": "Qualität einstellen",
    "Set time of first or last frame": "Zeit des ersten oder letzten Bildes setzen",
    "Show station map": "Stationskarte zeigen",
    "Solve smoke": "Rauch berechnen",
    "Stop running task": "Laufende Aufgabe beenden",
    "Suggest allocation of resources": "Zuteilung der Einsatzmittel vorschlagen",
    "Submit farm job": "Farm-Auftrag abschicken",
    "Try the King Fire": "King Fire ausprobieren",
    "View scene": "Szene ansehen",
    "Walk or fly with camera keys": "Gehen oder fliegen mit Kameraschlüsseln",
    "Write asset library": "Asset-Bibliothek schreiben",
    "Write farm job": "Farm-Auftrag schreiben",
    "Write smoke of frames": "Rauch von Bildern schreiben",
    # panels and menus
    "Background Renders": "Rendern im Hintergrund",
    "Begin at Event": "Beginn bei Ereignis",
    "Camera by Hand": "Kamera von Hand",
    "Cameras": "Kameras",
    "Compare With": "Vergleichen mit",
    "Content of the Run": "Inhalt des Laufs",
    "End at Event": "Ende bei Ereignis",
    "Fire": "Feuer",
    "Firetwin": "Firetwin",
    "Forecast": "Vorhersage",
    "Forest": "Wald",
    "Go to Place": "Zu Ort gehen",
    "Help": "Hilfe",
    "Jump to Event": "Zu Ereignis springen",
    "Labels": "Beschriftungen",
    "Lens and Sensor": "Objektiv und Sensor",
    "Light": "Licht",
    "Look at a Place": "Auf einen Ort richten",
    "On a farm": "Auf einer Farm",
    "Presets": "Vorlagen",
    "Rebuild Parts": "Teile neu bauen",
    "Render Settings": "Rendereinstellungen",
    "Report": "Bericht",
    "Reset Settings": "Einstellungen zurücksetzen",
    "Run": "Lauf",
    "Scene": "Szene",
    "Sensors": "Sensoren",
    "Smoke": "Rauch",
    "Station List": "Stationsliste",
    "Station Map": "Stationskarte",
    "Stations": "Stationen",
    "Story": "Geschichte",
    "Suggested Allocation": "Vorgeschlagene Zuteilung",
    "Terrain": "Gelände",
    "Tile Preview": "Kachelvorschau",
    "Tiles": "Kacheln",
    "Time": "Zeit",
    "Viewport": "Ansicht",
}
"""German names, by English names. Blender's own words (Szene, Rendern) as in its German interface."""

SETTINGS = {
    "EXR space": "EXR-Farbraum",
    "FPS": "Bilder pro Sekunde",
    "Film": "Film",
    "Film codec": "Film-Codec",
    "Slate": "Klappe",
    "Video": "Filme",
}
"""German labels of settings of films; labels of other settings stay English."""

CHOICES = {
    "Both": "Beide",
    "Clean": "Ohne Text",
    "Data": "Daten",
    "Editorial": "Schnitt",
    "Review": "Sichtung",
}
"""German names of choices of these settings, and of output presets."""

_CONTEXTS = ("*", "Operator")


def table() -> dict[str, dict[tuple[str, str], str]]:
    """Return the translations in Blender's layout: by language, and by context and English text."""
    german = GERMAN | SETTINGS | CHOICES
    return {"de_DE": {(context, text): own for text, own in german.items() for context in _CONTEXTS}}


def register() -> None:
    """Add the translations to Blender."""
    bpy.app.translations.register(__package__, table())


def unregister() -> None:
    """Remove the translations from Blender."""
    bpy.app.translations.unregister(__package__)
