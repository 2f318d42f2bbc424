"""Imagery tiles of a server: XYZ, TMS and WMTS in Web Mercator."""
