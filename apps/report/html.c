#include "report/html.h"

#include <stdlib.h>
#include <string.h>

#include "text/text.h"

#define BRIEF 30 /* letters of a cell that aren't broken into lines */

static const char style[] =
    "body{font:16px/1.55 system-ui,'DejaVu Sans',sans-serif;color:#222;background:#fff;max-width:62rem;margin:2rem "
    "auto;"
    "padding:0 1.2rem}h1{font-size:1.7rem;line-height:1.25;margin-bottom:.3rem}h2{font-size:1.25rem;margin-top:2.6rem;"
    "border-bottom:1px solid #ddd;padding-bottom:.25rem}p.lead{color:#555}p.note{background:#f6f3ea;padding:.6rem "
    ".9rem;"
    "border-left:4px solid #c9a94e}table{border-collapse:collapse;margin:1rem 0;font-size:.92rem;"
    "font-variant-numeric:tabular-nums}caption{text-align:left;color:#555;padding:.3rem 0;caption-side:top}"
    "th,td{padding:.28rem .7rem;border-bottom:1px solid #e4e4e4;text-align:left;vertical-align:top}"
    "th{border-bottom:2px solid #999;font-weight:600}td.n,th.n{text-align:right}td.s{white-space:nowrap}"
    "tr:hover td{background:#f7f9fb}figure{margin:1.2rem 0}"
    "img{max-width:100%;height:auto;border:1px solid #e4e4e4}figcaption{color:#555;font-size:.92rem}"
    "div.wide{overflow-x:auto}code{background:#f3f3f3;padding:0 .25em}nav a{margin-right:1rem}"
    "@media print{body{max-width:none}h2{break-after:avoid}figure,table{break-inside:avoid}}";

void ethd__html_text(FILE *page, const char *text) {
  for (; *text; text++) {
    if (*text == '&')
      fputs("&amp;", page);
    else if (*text == '<')
      fputs("&lt;", page);
    else if (*text == '>')
      fputs("&gt;", page);
    else if (*text == '"')
      fputs("&quot;", page);
    else
      fputc(*text, page);
  }
}

void ethd__html_begin(FILE *page, const char *title) {
  fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>",
        page);
  ethd__html_text(page, title);
  fprintf(page, "</title>\n<style>%s</style>\n</head>\n<body>\n<h1>", style);
  ethd__html_text(page, title);
  fputs("</h1>\n", page);
}

void ethd__html_end(FILE *page) { fputs("</body>\n</html>\n", page); }

void ethd__html_heading(FILE *page, const char *id, const char *text) {
  fprintf(page, "<h2 id=\"%s\">", id);
  ethd__html_text(page, text);
  fputs("</h2>\n", page);
}

/* ---- pictures ---- */

static void base64(FILE *page, const unsigned char *bytes, size_t length) {
  static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < length; i += 3) {
    size_t left = length - i;
    unsigned three =
        (unsigned)bytes[i] << 16 | (left > 1 ? (unsigned)bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    fputc(letters[three >> 18], page);
    fputc(letters[three >> 12 & 63], page);
    fputc(left > 1 ? letters[three >> 6 & 63] : '=', page);
    fputc(left > 2 ? letters[three & 63] : '=', page);
  }
}

bool ethd__html_picture(FILE *page, const char *path, const char *caption) {
  char message[ETHD_MESSAGE_MAX], *bytes;
  size_t length;
  if (ethd_text_read(path, (size_t)1 << 26, &bytes, &length, message)) return false;
  fputs("<figure><img alt=\"", page);
  ethd__html_text(page, caption);
  fputs("\" src=\"data:image/png;base64,", page);
  base64(page, (const unsigned char *)bytes, length);
  fputs("\"><figcaption>", page);
  ethd__html_text(page, caption);
  fputs("</figcaption></figure>\n", page);
  free(bytes);
  return true;
}

/* ---- tables ---- */

static void cells(FILE *page, const char *tag, const char *const *cell, int numbers) {
  fputs("<tr>", page);
  for (int i = 0; cell[i]; i++) {
    bool brief = tag[1] == 'd' && strlen(cell[i]) <= BRIEF;
    fprintf(page, "<%s class=\"%s%s\">", tag, i >= numbers ? "n" : "t", brief ? " s" : "");
    ethd__html_text(page, cell[i]);
    fprintf(page, "</%s>", tag);
  }
  fputs("</tr>\n", page);
}

void ethd__html_table(FILE *page, const char *caption, const char *const *header, int numbers) {
  fputs("<div class=\"wide\"><table>\n<caption>", page);
  ethd__html_text(page, caption);
  fputs("</caption>\n<thead>\n", page);
  cells(page, "th", header, numbers);
  fputs("</thead>\n<tbody>\n", page);
}

void ethd__html_row(FILE *page, const char *const *cell, int numbers) { cells(page, "td", cell, numbers); }

void ethd__html_table_end(FILE *page) { fputs("</tbody>\n</table></div>\n", page); }
