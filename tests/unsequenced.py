"""unsequenced.py FILE...: finds where one operand of an expression writes what another reads or writes, in an order that C
leaves open: f(take(&x), x), take(&x) + x, {take(&x), x}. gcc and clang find only x++ and x = ..., not a call that writes
through an address.

Clang's dump of its syntax tree is read, one node a line. An object is named by a path: the variable, the members that are
chosen, and * where a pointer is followed; elements of an array share the array's path. An operand writes what it assigns,
counts up, or hands to a call by a pointer to what isn't const, unless the function's body is there and follows no pointer when it
writes; it reads what it loads, or hands to a call by any pointer.
Two paths meet where one begins with the other and no pointer is followed after that."""
import multiprocessing, os, re, subprocess, sys

NODE = re.compile(r"([A-Z]\w+) 0x[0-9a-f]+ ?(.*)")
PLACE = re.compile(r"([^\s<>,:]+\.[chi]\w*|<scratch space>|<built-in>|line):(\d+):\d+") # col: stays on the line
UNEVALUATED = {"UnaryExprOrTypeTraitExpr", "OffsetOfExpr"}
SEQUENCED = {"','", "'&&'", "'||'"}
ASSIGNS = re.compile(r"'[-+*/%&|^]?=?='|'<<='|'>>='")


class Node:
    __slots__ = ("kind", "rest", "file", "line", "children")

    def __init__(self, kind, rest, file, line):
        self.kind, self.rest, self.file, self.line, self.children = kind, rest, file, line, []

    def operator(self):
        return re.findall(r"'[^']*'", self.rest)[-1] if self.kind != "UnaryOperator" else re.search(r"'(\+\+|--|[&*!~+-]|__\w+)'", self.rest).group()

    def types(self):
        found = re.match(r"(?:<[^>]*(?:<[^>]*>[^>]*)*> )?'([^']*)'(?::'([^']*)')?", self.rest)
        return [t for t in found.groups() if t] if found else []

    def cast(self):
        found = re.search(r"<(\w+)(?: [^>]*)?>$", self.rest)
        return found.group(1) if found else ""


def functions(source, flags):
    """The functions with a body that stand in the project's files, each as a tree."""
    clang = subprocess.run(["clang", "-fsyntax-only", "-w", "-Xclang", "-ast-dump", "-fno-color-diagnostics", *flags, source],
                           capture_output=True, text=True, env=os.environ | {"CCACHE_DISABLE": "1"}) # a ccache gives another file's tree
    if clang.returncode:
        raise RuntimeError(f"{source}: clang can't read it: {clang.stderr.strip()}")
    file, line, stack, found = source, 0, [], []
    for text in clang.stdout.splitlines():
        start = text.find("-") + 1
        if not start:
            continue
        depth = start // 2
        if depth > 1 and not stack and ".h:" not in text and ".c:" not in text:
            continue
        match = NODE.match(text, start)
        if not match:
            continue
        kind, rest = match.groups()
        first = None
        for name, a in PLACE.findall(rest[:rest.find("'")] if "'" in rest else rest):
            if name == "line":
                line = int(a)
            else:
                file, line = name, int(a)
            first = first or (file, line)
        if depth == 1:
            stack = []
            if kind != "FunctionDecl" or file.startswith(("/usr", "<")):
                continue
        elif not stack:
            continue
        node = Node(kind, rest, *(first or (file, line)))
        del stack[depth - 1:]
        if stack:
            stack[-1].children.append(node)
        else:
            found.append(node)
        stack.append(node)
    return [f for f in found if any(child.kind == "CompoundStmt" for child in f.children)]


def place(node):
    """The path of the object that an expression designates, or None."""
    if node.kind == "DeclRefExpr":
        found = re.search(r"(?:Var|ParmVar) (0x[0-9a-f]+) '([^']*)'", node.rest)
        return ((found.group(1), found.group(2)),) if found else None
    if node.kind == "MemberExpr":
        arrow, field = re.search(r"(->|\.)(\w*) 0x[0-9a-f]+$", node.rest).groups()
        base = pointee(node.children[0]) if arrow == "->" else place(node.children[0])
        return base and base + (("." + field if field else ".",) if field else ())
    if node.kind == "ArraySubscriptExpr":
        return next(filter(None, map(pointee, node.children)), None)
    if node.kind == "UnaryOperator" and node.operator() == "'*'":
        return pointee(node.children[0])
    if node.kind in ("ParenExpr", "ImplicitCastExpr", "CStyleCastExpr") and node.children:
        return place(node.children[-1])
    return None


def pointee(node):
    """The path of the object that a pointer's value points to, or None."""
    if node.kind in ("ParenExpr", "ImplicitCastExpr", "CStyleCastExpr") and node.children:
        how = node.cast()
        if how == "ArrayToPointerDecay":
            return place(node.children[0])
        if how == "LValueToRValue":
            base = place(node.children[0])
            return base and base + ("*",)
        return pointee(node.children[-1])
    if node.kind == "UnaryOperator" and node.operator() == "'&'":
        return place(node.children[0])
    if node.kind == "BinaryOperator" and node.operator() in ("'+'", "'-'"):
        return next(filter(None, map(pointee, node.children)), None)
    return None


def handed(node):
    """Of a call's argument: the path behind it, and whether the call may write there."""
    for kind in node.types():
        kind = re.sub(r"(\s*\b(const|restrict|volatile|__restrict)\b)+$", "", kind.strip())
        if kind.endswith("*"):
            to = kind[:-1].strip()
            const = to.endswith("const") if "*" in to else to.startswith("const ")
            return pointee(node), not const
    return None, False


def meet(a, b):
    short, long = sorted((a, b), key=len)
    return long[:len(short)] == short and "*" not in long[len(short):]


def writes_nothing(callee, known):
    """Whether a function of this file, seen whole, follows no pointer when it writes."""
    found = re.search(r"Function (0x[0-9a-f]+) '([^']*)'", callee.rest) if callee.kind == "DeclRefExpr" else None
    if not found and callee.children:
        return writes_nothing(callee.children[0], known)
    name = found and found.group(2)
    if name in known and not isinstance(known[name], bool):
        body, known[name] = known[name], False # a function that calls itself is taken to write
        known[name] = not any("*" in path for child in body.children for path in effects(child, set(), known)[1])
    return known.get(name, False)


def effects(node, findings, known):
    """What evaluating an expression or a statement reads and writes."""
    if node.kind in UNEVALUATED:
        return set(), set()
    parts = [effects(child, findings, known) for child in node.children]
    reads, writes = set().union(*(p[0] for p in parts)), set().union(*(p[1] for p in parts))
    if node.kind in ("CallExpr", "ArraySubscriptExpr", "InitListExpr", "CompoundAssignOperator") or \
            (node.kind == "BinaryOperator" and node.operator() not in SEQUENCED):
        if node.kind == "CompoundAssignOperator":
            parts[0] = (parts[0][0] | {place(node.children[0])} - {None}, parts[0][1])
        for i, (_, written) in enumerate(parts):
            for j, (read, also) in enumerate(parts):
                for w in written if i != j else ():
                    for r in read | also:
                        if meet(w, r):
                            findings.add((node.file, node.line, name(w)))
    own = None
    if node.kind == "CompoundAssignOperator" or (node.kind == "BinaryOperator" and node.operator() == "'='"):
        own = place(node.children[0])
    elif node.kind == "UnaryOperator" and node.operator() in ("'++'", "'--'"):
        own = place(node.children[0])
        reads |= {own} - {None}
    if own:
        writes |= {own}
    if node.kind == "ImplicitCastExpr" and node.cast() == "LValueToRValue":
        reads |= {place(node.children[0])} - {None}
    if node.kind == "CallExpr":
        harmless = writes_nothing(node.children[0], known)
        for argument in node.children[1:]:
            path, written = handed(argument)
            if path:
                reads |= {path}
                writes |= {path} if written and not harmless else set()
    return reads, writes


def name(path):
    text = path[0][1]
    for step in path[1:]:
        text = "*" + text if step == "*" else f"({text}){step}" if text.startswith("*") else text + step
    return re.sub(r"\(\*([\w>.-]+)\)\.", r"\1->", text)


def look(source):
    top = source.split("/")[0]
    flags = ["-std=gnu11", "-D_GNU_SOURCE", "-Iinclude"] + [f"-I{top}" for top in
             {"lib": ["lib"], "drivers": ["drivers", "drivers/runtime"],
              "apps": ["drivers", "drivers/runtime", "apps"]}.get(top, ["lib", "drivers", "drivers/runtime", "apps", "tests"])]
    if top in ("drivers", "apps", "tests"):  # as the Makefile compiles them
        flags += ["-include", "drivers/runtime/text/locale.h"]
    findings = set()
    sys.setrecursionlimit(10000)
    found = functions(source, flags)
    known = {re.search(r"(\w+) '", f.rest).group(1): f for f in found}
    for function in found:
        for child in function.children:
            effects(child, findings, known)
    return findings


if __name__ == "__main__":
    with multiprocessing.Pool(os.cpu_count()) as pool:
        found = set().union(*pool.map(look, sys.argv[1:], chunksize=4))
    for file, line, what in sorted(found):
        print(f"{file}:{line}: {what} is written by one operand and read or written by another, in no order")
    sys.exit(3 if found else 0)
