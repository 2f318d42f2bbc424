"""Stations and resources around a fire: one GeoPackage, importers, and search.

A station file stores stations with their positions and resources. Each row has a source (`records.Source`)
and an origin (`records.ORIGINS`): fact, exercise or user. Persons, telephone numbers and radio channels are
not stored.
"""
