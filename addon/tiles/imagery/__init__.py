"""Pictures of the ground by tiles of a server: XYZ, TMS and WMTS in Web Mercator."""
