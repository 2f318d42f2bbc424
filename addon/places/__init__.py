"""Stations and resources around a fire: one GeoPackage, its importers, and search. Needs no Blender.

A file of places holds where stations are and what stands there. Each row says where it comes from (`Source`)
and what it is (`ORIGINS` of `records`): a fact, part of an exercise, or the user's own. Nothing here knows a
person, a telephone number or a radio channel.
"""
