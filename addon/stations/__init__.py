"""Stations and resources around a fire: one GeoPackage, importers, search, and a suggested allocation.

A file of places holds where stations are and what stands there. Each row says where it comes from (`Source`)
and what it is (`ORIGINS` of `records`): a fact, part of an exercise, or the user's own. Nothing here knows a
person, a telephone number or a radio channel.
"""
