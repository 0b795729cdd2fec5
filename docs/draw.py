"""Draws the pictures of the gallery, small enough for a page: `python docs/draw.py [NAME ...]`."""

import subprocess
import sys
import tempfile
from pathlib import Path

from holdfast import builtin_hands, builtin_tasks
from PIL import Image

IMAGES = Path(__file__).resolve().parent / "images"
WIDTH = 960
COLOURS = 128


def draw(name: str, target: Path) -> None:
    """The picture that `holdfast show` makes of something built in, reduced to what a page shows."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "shown.png"
        words = [sys.executable, "-P", "-m", "holdfast", "show", name, "--out", str(path), "--quiet"]
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
        picture = Image.open(path).convert("RGB")
        picture.thumbnail((WIDTH, WIDTH))
        target.parent.mkdir(parents=True, exist_ok=True)
        picture.quantize(COLOURS).save(target, optimize=True)


def main() -> None:
    """Draws those that are named, or all that is built in, but for other regions of the same tasks."""
    tasks = [name for name in builtin_tasks() if "/" not in name]
    for name in sys.argv[1:] or (*tasks, *builtin_hands()):
        print(name, flush=True)
        draw(name, IMAGES / "gallery" / f"{name}.png")


if __name__ == "__main__":
    main()
