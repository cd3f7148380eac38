#!/bin/sh
# Every include points to its own floor or to a lower one. From the ground up: lib's maths and its root; guard, scene,
# solids, estimate and law; core; control; drivers; apps. A public header stands on the floor of the library that it links
# from. Nothing but these rooms is kept at the top.
top=$(git ls-files 2>/dev/null | cut -d/ -f1 | grep -v '^[.]' | LC_ALL=C sort -u | tr '\n' ' ')
case $top in
  '' | 'LICENSE Makefile README.md apps drivers include lib tests ') ;;
  *) echo "at the top stand: $top"; exit 1 ;;
esac
exec "${PYTHON:-python3}" - <<'END'
import pathlib, re, sys

FLOORS = [r"lib/maths/|lib/[^/]*$", r"lib/(guard|scene|solids|estimate|law)/", r"lib/core/", r"lib/(control|space)/", r"drivers/", r"apps/"]

def floor(path):
    text = path.as_posix()
    if text.startswith("include/"):
        return 4 if "Links from libethd-drivers" in path.read_text()[:400] else 0
    return next(i for i, pattern in enumerate(FLOORS) if re.match(pattern, text))

def resolve(path, name):
    for root in [path.parent, *map(pathlib.Path, ("include", "lib", "drivers", "drivers/runtime", "apps"))]:
        if (root / name).is_file():
            return root / name

up = [f"{path} includes {to}" for top in ("include", "lib", "drivers", "apps")
      for path in sorted(pathlib.Path(top).rglob("*.[ch]"))
      for name in re.findall(r'^\s*#\s*include "([^"]+)"', path.read_text(), re.M)
      for to in [resolve(path, name)] if to and floor(to) > floor(path)]
rooms = {}
for path in pathlib.Path(".").glob("[lda]*/**/*.c"):
    rooms.setdefault(path.parent, []).append(path)
up += [f"{room} has {len(files)} sources: 25 are a room's most" for room, files in rooms.items() if len(files) > 25]
print("\n".join(up))
sys.exit(bool(up))
END
