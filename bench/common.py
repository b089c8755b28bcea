"""What the scripts of bench/ share: the names in the figures of `configurations`."""
import json
import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOUBLE = "double"


def configurations(figures):
    """Names of all configurations, double precision first."""
    names = [name.split(".")[1] for name in figures if name.startswith("configuration.") and name.endswith(".title")]
    return sorted(names, key=lambda name: name != DOUBLE)


def scenes_of(figures):
    """Names of all scenes, in the order in which they were measured."""
    return [name.split(".")[1] for name in figures
            if name.startswith("error.") and name.endswith(f".{DOUBLE}.rmse") and name.count(".") == 3]


def write_json(path, value):
    """Replaces a file in one step, so that a reader never sees half of it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.{os.getpid()}")
    part.write_text(json.dumps(value, indent=2) + "\n")
    part.replace(path)
