"""Edits: a cut of a film's cameras with markers, as OTIO, Final Cut Pro 7 XML and EDL."""
