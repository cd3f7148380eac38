"""Whether each table of a page fits a window of 1100 pixels: its columns as narrow as words that can't be broken let them be.
The figures are those of the page's style there, and of DejaVu Sans, which is wider than most.
"""
import html
import re
import sys

WINDOW, SCROLL_BAR, SIDES = 1100, 15, 2 * 1.2 * 16
FONT, PADDING = 0.84 * 16, 2 * 0.4 * 0.84 * 16
NARROW = " \u00a0.,()-|/:'ijlt"  # about 0.37 of the font's size; digits and most letters 0.64
BOLD = 1.09


def narrowest(tag, classes, words):
    pieces = [words] if "s" in classes.split() else words.split(" ")
    size = max(sum(0.37 if letter in NARROW else 0.64 for letter in piece) for piece in pieces)
    return size * FONT * (BOLD if tag == "th" else 1) + PADDING


page = open(sys.argv[1], encoding="utf-8").read()
wide = []
for table in re.findall(r"<table>.*?</table>", page, re.S):
    columns = {}
    for row in re.findall(r"<tr>.*?</tr>", table, re.S):
        for i, (tag, classes, words) in enumerate(re.findall(r'<(t[hd]) class="([^"]*)">(.*?)</t[hd]>', row)):
            columns[i] = max(columns.get(i, 0), narrowest(tag, classes, html.unescape(words)))
    if sum(columns.values()) > WINDOW - SCROLL_BAR - SIDES:
        wide.append(f"{sum(columns.values()):.0f} pixels: {re.search('<caption>(.*?)</caption>', table).group(1)}")
sys.exit("\n".join(wide) or 0)
