"""Cuts: clips of films on a timeline with markers, written as OTIO, Final Cut Pro 7 XML and EDL."""
