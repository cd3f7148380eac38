#!/bin/sh
# A type's name stands for one thing in lib: no two of its files define types of the same name, and no file of it defines one
# that a public header has.
exec "${PYTHON:-python3}" - <<'END'
import collections, pathlib, re, sys

def defined(text):
    text = re.sub(r"/\*.*?\*/|//[^\n]*", " ", text, flags=re.S)
    tags = re.findall(r"\b(?:struct|union|enum)\s+(\w+)\s*\{", text)
    names = re.findall(r"^\}\s*(\w+);", text, re.M) + re.findall(r"^typedef\s[^{};]*?(\w+)(?:\s+__attribute__[^;]*)?;", text, re.M)
    opaque = re.findall(r"^typedef\s+struct\s+(\w+)\s+\1;", text, re.M) # its body stands elsewhere
    return (set(tags) | set(names)) - set(opaque)

assert defined("typedef struct a {\n int x;\n} a;\nstruct b { int y; };\ntypedef struct c c;\ntypedef double d;") == {"a", "b", "d"}
where = collections.defaultdict(list)
for top in ("include/ethd", "lib"):
    for path in sorted(pathlib.Path(top).rglob("*.[ch]")):
        for name in defined(path.read_text()):
            where[name].append(str(path))
twice = [f"{name} is defined in {' and '.join(files)}" for name, files in sorted(where.items()) if len(files) > 1]
print("\n".join(twice) or f"{len(where)} types")
sys.exit(bool(twice))
END
