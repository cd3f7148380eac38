# For tests of symbols: the public functions and data. Sourced.

# Names marked ETHD_API in the public headers, comments and preprocessor lines left out; ethd_plugin, ethd_driver_plugin are
# the symbols that a plugin defines.
declared() {
  [ $# -gt 0 ] || set -- include/ethd/*.h
  cat "$@" | awk '
    { text = text $0 "\n" }
    END {
      while ((i = index(text, "/*")) > 0) {
        rest = substr(text, i + 2); j = index(rest, "*/")
        text = substr(text, 1, i - 1) " " substr(rest, j + 2)
      }
      n = split(text, lines, "\n"); text = ""; carry = 0
      for (k = 1; k <= n; k++) {
        if (!carry && lines[k] !~ /^[ \t]*#/) { sub(/\/\/.*/, "", lines[k]); text = text " " lines[k] }
        else { carry = (lines[k] ~ /\\$/); continue }
      }
      n = split(text, statements, /[;{}]/)
      for (k = 1; k <= n; k++) {
        s = statements[k]
        if (!match(s, /(^|[^A-Za-z0-9_])ETHD_API([^A-Za-z0-9_]|$)/)) continue
        s = substr(s, RSTART + RLENGTH)
        if (match(s, /[a-z_][A-Za-z0-9_]*[ \t]*\(/)) {
          name = substr(s, RSTART, RLENGTH); sub(/[ \t]*\(/, "", name); print name
        } else {
          m = split(s, names, ",")
          for (i = 1; i <= m; i++) { sub(/[ \t]*(\[.*)?$/, "", names[i]); sub(/.*[^A-Za-z0-9_]/, "", names[i]); print names[i] }
        }
      }
    }' | grep -vxE "ethd_plugin|ethd_driver_plugin" | sort -u
}
