"""A page that stands alone: no script, no other file. Whatever isn't markup of our own is escaped here, and nothing else
writes to a page."""
import base64
import html
import re
from concurrent.futures import Future
from typing import List, Optional, Sequence, Union

_BRIEF = 17  # letters of a cell that isn't broken into lines: every column fits a window of 1100 pixels

_STYLE = (
    "body{font:16px/1.55 system-ui,'DejaVu Sans',sans-serif;color:#222;background:#fff;max-width:74rem;margin:2rem auto;"
    "padding:0 1.2rem}h1{font-size:1.7rem;line-height:1.25;margin-bottom:.3rem}h2{font-size:1.25rem;margin-top:2.6rem;"
    "border-bottom:1px solid #ddd;padding-bottom:.25rem}p.lead{color:#555}p.note{background:#f6f3ea;padding:.6rem .9rem;"
    "border-left:4px solid #c9a94e}table{border-collapse:collapse;margin:1rem 0;font-size:.92rem;"
    "font-variant-numeric:tabular-nums}caption{text-align:left;color:#555;padding:.3rem 0;caption-side:top}"
    "th,td{padding:.28rem .6rem;border-bottom:1px solid #e4e4e4;text-align:left;vertical-align:top}"
    "th{border-bottom:2px solid #999;font-weight:600}td.n,th.n{text-align:right}td.s{white-space:nowrap}"
    "td.w{font-weight:600;padding-top:.8rem}tr:hover td{background:#f7f9fb}figure{margin:1.2rem 0}"
    "img{max-width:100%;height:auto;border:1px solid #e4e4e4}figcaption{color:#555;font-size:.92rem}"
    "div.wide,pre{overflow-x:auto}code{background:#f3f3f3;padding:0 .25em;overflow-wrap:anywhere}nav a{margin-right:1rem;white-space:nowrap}"
    "@media(max-width:1250px){table{font-size:.84rem}th,td{padding:.25rem .4rem}}"
    "@media print{@page{size:A4;margin:12mm}body{max-width:none}h2{break-after:avoid}figure{break-inside:avoid}"
    "tr{break-inside:avoid}div.wide{overflow:visible}table{font-size:62%}img{max-height:24cm;width:auto}"
    "th,td{padding:1px 4px;white-space:normal}pre{white-space:pre-wrap}}"
)


def escaped(text: str) -> str:
    return re.sub(r"[\0-\x1f\x7f]", "?", html.escape(text))


class Page:
    def __init__(self) -> None:
        self._parts: List[Union[str, "Future[bytes]"]] = []
        self.names = {"methods"}  #: of headings; that one comes last

    def put(self, markup: str, *values: Union[str, int, float]) -> None:
        """Trusted markup: each %s takes text, which is escaped; %d, %g and so on take numbers."""
        self._parts.append(markup % tuple(escaped(v) if isinstance(v, str) else v for v in values) if values else markup)

    def add(self, other: "Page") -> None:
        self._parts += other._parts

    def heading(self, name: str, text: str) -> None:
        self.names.add(name)
        self.put('<h2 id="%s">%s</h2>\n', name, text)

    def picture(self, png: "Future[bytes]", caption: str) -> None:
        """The PNG itself, with words for those who can't see it. It may still be drawn."""
        self.put('<figure><img alt="%s" src="data:image/png;base64,', caption)
        self._parts.append(png)
        self.put('"><figcaption>%s</figcaption></figure>\n', caption)

    # ---- tables ----

    def _row(self, tag: str, cells: Sequence[Optional[str]], numbers: int) -> None:
        self.put("<tr>")
        for i, cell in enumerate(c for c in cells if c is not None):
            brief = " s" if tag == "td" and len(cell) <= _BRIEF else ""
            self.put(f'<{tag} class="{"n" if i >= numbers else "t"}{brief}">%s</{tag}>', cell)
        self.put("</tr>\n")

    def table(self, caption: str, header: Sequence[Optional[str]], numbers: int) -> None:
        """Begins a table; rows follow. Cells from `numbers` on are aligned to the right; None is no cell."""
        self._numbers = numbers
        self.put('<div class="wide"><table>\n<caption>%s</caption>\n<thead>\n', caption)
        self._row("th", header, numbers)
        self.put("</thead>\n<tbody>\n")

    def row(self, *cells: Optional[str]) -> None:
        self._row("td", cells, self._numbers)

    def span(self, text: str, columns: int) -> None:
        """One cell over several columns, the heading of the rows below it."""
        self.put('<tr><td class="w" colspan="%d">%s</td></tr>\n', columns, text)

    def end_table(self) -> None:
        self.put("</tbody>\n</table></div>\n")

    def whole(self, title: str) -> bytes:
        """The file, once all pictures are drawn."""
        head = (f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
                f'<meta name="viewport" content="width=device-width,initial-scale=1">\n<title>{escaped(title)}</title>\n'
                f"<style>{_STYLE}</style>\n</head>\n<body>\n<h1>{escaped(title)}</h1>\n")
        body = b"".join(p.encode() if isinstance(p, str) else base64.b64encode(p.result()) for p in self._parts)
        return head.encode() + body + b"</body>\n</html>\n"


# ---- words for numbers ----


def number_text(value: float, digits: int) -> str:
    return "-" if value != value else f"{value:.{digits}f}"


def mean_text(n: int, mean: float, sd: float, digits: int) -> str:
    return "-" if not n else f"{mean:.{digits}f}" if n == 1 else f"{mean:.{digits}f} ({sd:.{digits}f})"


def interval_text(low: float, high: float, digits: int) -> str:
    return "-" if low != low or high != high else f"{low:.{digits}f}\u00a0to\u00a0{high:.{digits}f}"


def p_text(p: float) -> str:
    return "-" if p != p else "< 0.0001" if p < 1e-4 else f"{p:.4f}"
