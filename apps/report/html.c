#include "report/html.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "text/text.h"

#define BRIEF 30 /* letters of a cell that aren't broken into lines */

static const char style[] =
    "body{font:16px/1.55 system-ui,'DejaVu Sans',sans-serif;color:#222;background:#fff;max-width:74rem;margin:2rem "
    "auto;"
    "padding:0 1.2rem}h1{font-size:1.7rem;line-height:1.25;margin-bottom:.3rem}h2{font-size:1.25rem;margin-top:2.6rem;"
    "border-bottom:1px solid #ddd;padding-bottom:.25rem}p.lead{color:#555}p.note{background:#f6f3ea;padding:.6rem "
    ".9rem;"
    "border-left:4px solid #c9a94e}table{border-collapse:collapse;margin:1rem 0;font-size:.92rem;"
    "font-variant-numeric:tabular-nums}caption{text-align:left;color:#555;padding:.3rem 0;caption-side:top}"
    "th,td{padding:.28rem .6rem;border-bottom:1px solid #e4e4e4;text-align:left;vertical-align:top}"
    "th{border-bottom:2px solid "
    "#999;font-weight:600}td.n,th.n{text-align:right}td.s{white-space:nowrap}td.w{font-weight:600;padding-top:.8rem}"
    "tr:hover td{background:#f7f9fb}figure{margin:1.2rem 0}"
    "img{max-width:100%;height:auto;border:1px solid #e4e4e4}figcaption{color:#555;font-size:.92rem}"
    "div.wide{overflow-x:auto}code{background:#f3f3f3;padding:0 .25em}nav a{margin-right:1rem}"
    "@media print{@page{size:A4;margin:12mm}"
    "body{max-width:none}h2{break-after:avoid}figure{break-inside:avoid}"
    "tr{break-inside:avoid}div.wide{overflow:visible}table{font-size:62%}img{max-height:24cm;width:auto}th,td{padding:"
    "1px 4px;white-space:normal}"
    "pre{white-space:pre-wrap}}";

/* ---- text and markup ---- */

void ethd__html_markup(ethd__html *page, const char *literal) { fputs(literal, page->file); }

void ethd__html_append(ethd__html *page, const char *written, size_t length) { fwrite(written, 1, length, page->file); }

void ethd__html_text(ethd__html *page, const char *text) {
  for (; *text; text++) switch (*text) {
    case '&': fputs("&amp;", page->file); break;
    case '<': fputs("&lt;", page->file); break;
    case '>': fputs("&gt;", page->file); break;
    case '"': fputs("&quot;", page->file); break;
    case '\'': fputs("&#39;", page->file); break;
    default: putc((unsigned char)*text < ' ' || *text == 0x7f ? '?' : *text, page->file);
    }
}

/* One conversion, "%zu" and the like, with its argument. */
static void put_number(ethd__html *page, const char *spec, va_list *args) {
  char text[64];
  size_t last = strlen(spec) - 1;
  if (strchr("efg", spec[last]))
    snprintf(text, sizeof text, spec, va_arg(*args, double));
  else if (spec[last - 1] == 'z')
    snprintf(text, sizeof text, spec, va_arg(*args, size_t));
  else if (spec[last - 1] == 'l')
    snprintf(text, sizeof text, spec, va_arg(*args, unsigned long long));
  else
    snprintf(text, sizeof text, spec, va_arg(*args, int));
  ethd__html_text(page, text);
}

void ethd__html_print(ethd__html *page, const char *format, ...) {
  va_list args;
  va_start(args, format);
  for (const char *p = format; *p; p++) {
    char spec[16];
    size_t n = *p == '%' ? strcspn(p + 1, "sdugef%") + 2 : 0;
    if (!n || p[1] == '%' || n >= sizeof spec) {
      putc(*p, page->file);
      p += n && p[1] == '%';
      continue;
    }
    memcpy(spec, p, n);
    spec[n] = 0;
    if (!strcmp(spec, "%s"))
      ethd__html_text(page, va_arg(args, const char *));
    else
      put_number(page, spec, &args);
    p += n - 1;
  }
  va_end(args);
}

void ethd__html_begin(ethd__html *page, const char *title) {
  ethd__html_print(
      page,
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>%s</title>\n<style>",
      title);
  ethd__html_markup(page, style);
  ethd__html_print(page, "</style>\n</head>\n<body>\n<h1>%s</h1>\n", title);
}

void ethd__html_end(ethd__html *page) { ethd__html_markup(page, "</body>\n</html>\n"); }

void ethd__html_heading(ethd__html *page, const char *id, const char *text) {
  ethd__html_print(page, "<h2 id=\"%s\">%s</h2>\n", id, text);
}

/* ---- pictures ---- */

static void base64(FILE *file, const unsigned char *bytes, size_t length) {
  static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < length; i += 3) {
    size_t left = length - i;
    unsigned three =
        (unsigned)bytes[i] << 16 | (left > 1 ? (unsigned)bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    fputc(letters[three >> 18], file);
    fputc(letters[three >> 12 & 63], file);
    fputc(left > 1 ? letters[three >> 6 & 63] : '=', file);
    fputc(left > 2 ? letters[three & 63] : '=', file);
  }
}

bool ethd__html_picture(ethd__html *page, const char *path, const char *caption) {
  char message[ETHD_MESSAGE_MAX], *bytes;
  size_t length;
  if (ethd_text_read(path, (size_t)1 << 26, &bytes, &length, message)) return false;
  ethd__html_print(page, "<figure><img alt=\"%s\" src=\"data:image/png;base64,", caption);
  base64(page->file, (const unsigned char *)bytes, length);
  ethd__html_print(page, "\"><figcaption>%s</figcaption></figure>\n", caption);
  free(bytes);
  return true;
}

/* ---- tables ---- */

static void cells(ethd__html *page, const char *tag, const char *const *cell, int numbers) {
  ethd__html_markup(page, "<tr>");
  for (int i = 0; cell[i]; i++) {
    bool brief = tag[1] == 'd' && strlen(cell[i]) <= BRIEF;
    ethd__html_print(page, "<%s class=\"%s%s\">%s</%s>", tag, i >= numbers ? "n" : "t", brief ? " s" : "", cell[i],
                     tag);
  }
  ethd__html_markup(page, "</tr>\n");
}

void ethd__html_table(ethd__html *page, const char *caption, const char *const *header, int numbers) {
  ethd__html_print(page, "<div class=\"wide\"><table>\n<caption>%s</caption>\n<thead>\n", caption);
  cells(page, "th", header, numbers);
  ethd__html_markup(page, "</thead>\n<tbody>\n");
}

void ethd__html_row(ethd__html *page, const char *const *cell, int numbers) { cells(page, "td", cell, numbers); }

void ethd__html_span(ethd__html *page, const char *text, int columns) {
  ethd__html_print(page, "<tr><td class=\"w\" colspan=\"%d\">%s</td></tr>\n", columns, text);
}

void ethd__html_table_end(ethd__html *page) { ethd__html_markup(page, "</tbody>\n</table></div>\n"); }
