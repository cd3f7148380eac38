"""No word of an SVG by gnuplot lies on another one or leaves the picture, and in a picture of a tap none lies on a coloured curve:
plot_words.py FILE.svg..

How wide a word is follows from what DejaVu Sans is wide, to a tenth."""
import html, re, sys

GROUP = re.compile(r'<g transform="translate\(([-\d.]+),([-\d.]+)\)(?: rotate\(([-\d.]+)\))?"[^>]*font-size="([\d.]+)"[^>]*text-anchor="(\w+)"[^>]*>\s*<text>(.*?)</text>', re.S)
SPAN = re.compile(r"<tspan([^>]*)>(.*?)</tspan>", re.S)

def advance(letter):
    return 0.29 if letter in "iljI.,:;'|!" else 0.37 if letter in " ftr()-/" else 0.94 if letter in "mwMW%" else 0.62

def words(text):
    for x, y, turn, size, anchor, inside in GROUP.findall(text):
        width, whole = 0.0, ""
        for attributes, word in SPAN.findall(inside) or [("", inside)]:
            own = re.search(r'font-size="([\d.]+)"', attributes)
            word = html.unescape(word)
            width += sum(map(advance, word)) * float(own.group(1) if own else size)
            whole += word
        if not whole.strip():
            continue
        left = {"start": 0, "middle": -width / 2, "end": -width}[anchor]
        x, y, size = float(x), float(y), float(size)
        if turn and abs(float(turn)) > 45:
            yield whole, (x - 0.7 * size, y - left - width, x + 0.15 * size, y - left)
        elif not turn or float(turn) == 0:
            yield whole, (x + left, y - 0.7 * size, x + left + width, y + 0.15 * size)

def curves(text):
    """Points of coloured lines, a pixel apart or less; what isn't grey is data."""
    for red, green, blue, line in re.findall(r"<path stroke='rgb\( *(\d+), *(\d+), *(\d+)\)'[^>]* d='([^']*)'", text):
        if max(map(int, (red, green, blue))) - min(map(int, (red, green, blue))) < 30:
            continue
        x = y = None
        for move, u, v in re.findall(r"([ML])([-\d.]+),([-\d.]+)", line):
            u, v = float(u), float(v)
            steps = int(max(abs(u - x), abs(v - y))) + 1 if move == "L" else 1
            for k in range(1, steps + 1):
                yield (u, v) if move == "M" else (x + (u - x) * k / steps, y + (v - y) * k / steps)
            x, y = u, v


failed = 0
for path in sys.argv[1:]:
    text = open(path).read()
    wide, high = map(float, re.search(r'width="([\d.]+)" height="([\d.]+)"', text).groups())
    found = list(words(text))
    count = len(found)
    for word, (x0, y0, x1, y1) in found:
        if x0 < -2 or y0 < -2 or x1 > wide + 2 or y1 > high + 2:
            print(f"FAILED {path}: \"{word.strip()}\" leaves the picture: {x0:.0f} to {x1:.0f} of {wide:.0f}, {y0:.0f} to {y1:.0f} of {high:.0f}")
            failed += 1
    for i, (a, (x0, y0, x1, y1)) in enumerate(found):
        for b, (u0, v0, u1, v1) in found[i + 1:]:
            if min(x1, u1) - max(x0, u0) > 1.5 and min(y1, v1) - max(y0, v0) > 1.5:
                print(f"FAILED {path}: \"{a.strip()}\" lies on \"{b.strip()}\"")
                failed += 1
    for x, y in curves(text) if "-tap-" in path else ():
        for word, (x0, y0, x1, y1) in found:
            if x0 + 1.5 < x < x1 - 1.5 and y0 + 1.5 < y < y1 - 1.5:
                print(f"FAILED {path}: \"{word.strip()}\" lies on a curve at {x:.0f}, {y:.0f}")
                failed += 1
                found.remove((word, (x0, y0, x1, y1)))
                break
    print(f"{path.split('/')[-1]}: {count} words")
    failed += count < 6
sys.exit(failed > 0)
