"""A report's tables beside those of a reference: exact figures to 1e-9, drawn ones within their noise.

report_reference.py OLD NEW   folders with a folder of tables for each study, NAME/report/*.csv
"""
import csv, math, pathlib, sys

# Figures that are drawn: shares of at least 1000 draws, and ends of intervals.
SHARES = {"summary": {"dip_p"}, "table1": {"mean_as_far_off", "sd_as_far_off"}, "pairs": {"p", "p_holm"}, "interaction": {"p", "p_holm"},
          "claims": {"p", "p_claim", "p_holm"}}
ENDS = {"summary": ("median_low", "median_high"), "pairs": ("cliff_low", "cliff_high"), "claims": ("low", "high")}
GRAIN = {"ms": 1, "mm": 0.1, "m/s": 0.01} # to which the taps of one study are rounded, at most
EXACT_PEOPLE = 16 # up to whom all signs are flipped

failed, compared, worst = [], 0, 0.0

def number(cell):
    try:
        return float(cell)
    except ValueError:
        return None

def is_drawn(table, column, row):
    if table == "claims":
        is_threshold = row["test"] == "bootstrap"
        if column in ("low", "high"):
            return is_threshold
        flips = row["test"] == "sign flip" and int(row["participants"]) > EXACT_PEOPLE
        return column in SHARES[table] and (is_threshold or flips or column != "p")
    if table in ("pairs", "interaction") and column == "p":
        return int(row["participants"]) > EXACT_PEOPLE
    return column in SHARES.get(table, ()) or column in ENDS.get(table, ())

def bound(table, column, row, old):
    if not is_drawn(table, column, row):
        # the former noncentral t had eight digits with two degrees of freedom
        return 3e-8 if column in ("d_z_low", "d_z_high") and int(row["participants"]) < 6 else 1e-9 * max(1, abs(old))
    if column in SHARES[table]:
        return (5 * math.sqrt(max(0, old * (1 - old)) / 1000) + 1e-2) * (10 if column == "p_holm" else 1)
    low, high = (float(row[name]) for name in ENDS[table])
    return high - low + (GRAIN.get(row["unit"], 0) if table == "summary" else 0)

def compare(what, table, row, new):
    global compared, worst
    for column, there, here in zip(row, row.values(), new.values()):
        old, value = number(there), number(here)
        compared += 1
        if old is None or value is None:
            if there != here:
                failed.append(f"{what}: {column}: found {here!r}, it was {there!r}")
            continue
        allowed = bound(table, column, row, old)
        if not abs(value - old) <= allowed:
            failed.append(f"{what}: {column}: found {here}, it was {there}; {allowed:.1e} is allowed")
        elif allowed <= 1e-9 * max(1, abs(old)):
            worst = max(worst, abs(value - old) / max(1, abs(old)))

def rows(path):
    with open(path, newline="") as f:
        return list(csv.DictReader(f))

old_folder, new_folder = map(pathlib.Path, sys.argv[1:])
tables = sorted(p.relative_to(old_folder) for p in old_folder.glob("*/report/*.csv"))
extra = sorted(p.relative_to(new_folder) for p in new_folder.glob("*/report/*.csv") if p.relative_to(new_folder) not in tables)
failed += [f"{path}: a table that wasn't there" for path in extra]
for path in tables:
    if not (new_folder / path).exists():
        failed.append(f"{path}: missing")
        continue
    old, new = rows(old_folder / path), rows(new_folder / path)
    if len(old) != len(new) or (old and list(old[0]) != list(new[0])):
        failed.append(f"{path}: {len(new)} rows of {list(new[0]) if new else []}; they were {len(old)} of {list(old[0]) if old else []}")
        continue
    for k, (a, b) in enumerate(zip(old, new)):
        compare(f"{path}:{k + 2}", path.stem, a, b)
for line in failed[:12]:
    print("FAILED", line)
print(f"{compared} cells of {len(tables)} tables: {len(failed)} differ; exact ones by {worst:.1e} at most")
sys.exit(bool(failed) or not tables)
