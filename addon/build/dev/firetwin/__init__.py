"""Development stub: the package firetwin straight from the sources of /work/main/addon."""
__path__ = ["/work/main/addon/addon", "/work/main/addon"]
exec(compile(open("/work/main/addon/addon/__init__.py").read(), "/work/main/addon/addon/__init__.py", "exec"))
