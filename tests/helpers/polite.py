"""Error messages of the command line: one line that a person can read."""


def rude(line):
    """Fault of an error message of `cli`, or an empty text."""
    if not line:
        return ""
    text = line.removesuffix("\n")
    if not text.startswith("firetwin: ") or "unexpected" in text[:22]:
        return "not meant"
    if len(text) > 2020:
        return "too long"
    return "" if text.isprintable() else "not printable"
