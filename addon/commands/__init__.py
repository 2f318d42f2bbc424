"""Commands of the command line: each module declares one; heavy modules are imported when it runs."""
