#!/bin/sh
# One name, one thing: in include, lib, drivers and apps no struct, union, enum or typedef has two bodies, be it in headers
# or in sources, and no macro or enumerator of a header has another value elsewhere. (Those that only sources define are
# constants of one file each.) Include guards are named after their files.
exec "${PYTHON:-python3}" - <<'END'
import pathlib, re, sys

COMMENT = re.compile(r'/\*.*?\*/|//[^\n]*|("(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\')', re.S)
HEAD = re.compile(r"^(?:static |extern |const )*(typedef )?(?:(struct|union|enum)\b(?: ETHD_\w+)* ?(\w*)) ?\{", re.M)
PLAIN = re.compile(r"^typedef ((?!(?:struct|union|enum)\b[^;(]*\{)[^{;]*);", re.M)

def body_end(text, start):
    depth = 0
    for i in range(start, len(text)):
        depth += {"{": 1, "}": -1}.get(text[i], 0)
        if depth == 0:
            return i
    raise ValueError("a brace stays open")

def definitions(text):
    """(name, body) of everything that a file defines at its outermost level."""
    text = COMMENT.sub(lambda m: m.group(1) or " ", text).replace("\\\n", " ")
    for m in re.finditer(r"^[ \t]*#[ \t]*define[ \t]+(\w+)(.*)$", text, re.M):
        # what its file takes back is a name of that file's alone
        if not re.search(rf"^[ \t]*#[ \t]*undef[ \t]+{m.group(1)}\b", text, re.M):
            yield "constant " + m.group(1), m.group(2).strip()
    for m in HEAD.finditer(text):
        end = body_end(text, m.end() - 1)
        body = m.group(2) + text[m.end() - 1:end + 1]
        for name in {m.group(3)} | set(re.findall(r"\w+", text[end + 1:text.index(";", end)]) if m.group(1) else ()):
            if name:
                yield name, body
        if m.group(2) == "enum":
            for name, value in re.findall(r"[{,]\s*([A-Z]\w+)\s*(=[^,}]*)?(?=[,}])", body):
                yield "constant " + name, value.lstrip("= ") or body # without a value, where it stands says which it has
    for m in PLAIN.finditer(text):
        whole = m.group(1)
        if name := re.search(r"\(\s*\*?(\w+)\s*\)\s*\(|(\w+)\s*(?:\[[^\]]*\]|ETHD_\w+|__attribute__.*)*$", whole):
            name = name.group(1) or name.group(2)
            if not re.fullmatch(rf"(struct|union|enum) \w+ {name}", whole):
                yield name, whole

def guard(path):
    """ETHD__ROOM_FILE_H; a program's room has APPS_ before it, because the libraries may have a room of that name."""
    top, *rest = [part for part in path.with_suffix("").parts if part != "runtime"]
    return "ETHD__" + ("APPS_" if top == "apps" else "") + "_".join(rest).upper().replace("-", "_") + "_H"

unguarded = [path.as_posix() for top in ("lib", "drivers", "apps") for path in sorted(pathlib.Path(top).rglob("*.h"))
             if "firmware" not in path.parts and f"#ifndef {guard(path)}\n#define {guard(path)}\n" not in path.read_text()]
for path in unguarded:
    print(f"FAILED: {path}: its include guard isn't {guard(pathlib.Path(path))}")

bodies = {}
for top in ("include", "lib", "drivers", "apps"):
    for path in sorted(pathlib.Path(top).rglob("*.[ch]")):
        here = {} # what a file defines twice stands in branches of an #if, and is one thing
        for name, body in definitions(path.read_text()):
            here.setdefault(name, set()).add(" ".join(body.split()))
        for name, found in here.items():
            bodies.setdefault(name, {}).setdefault(" | ".join(sorted(found)), []).append(path.as_posix())
seen = {name for name, found in bodies.items() if any(f.endswith(".h") for files in found.values() for f in files)}
twice = {name: found for name, found in bodies.items() if len(found) > 1 and (" " not in name or name in seen)}
for name in sorted(twice):
    print(f"FAILED: {name} is {len(twice[name])} things:", "; ".join(", ".join(files) for files in twice[name].values()))
print(f"{len(bodies)} names, each stands for one thing" if not twice else f"{len(twice)} names stand for more than one thing")
sys.exit(bool(twice or unguarded))
END
