#!/bin/sh
# No operand writes what another one of the same expression uses: the order is the compiler's. Looks at lib;
# ETHD_UNSEQUENCED=all: at drivers, apps and tests as well, as make ci does. First, at a file with known answers.
. tests/begin.sh
python3=${PYTHON:-python3}
cat >"$folder/known.c" <<'END'
typedef struct pair { int a, b; } pair;
extern int take(int *x), look(const int *x), two(int, int), use(pair *p);
extern void sink(int, ...);
static int first(int *x) { return *x; }
static int hands_on(int *x) { return take(x); }
static pair state;
extern pair *role(int l, int id, int *at);
int f1(int x) { return two(take(&x), x); }            /* found */
int f2(int x) { return two(x, take(&x)); }            /* found */
int f3(int x) { return x + take(&x); }                /* found */
int f4(int x) { return take(&x) - x; }                /* found */
int f5(int x) { int y[2] = {take(&x), x}; return *y; }/* found */
int f6(int *x) { return two(take(x), *x); }           /* found */
int f7(pair *p) { return two(take(&p->a), p->a); }    /* found */
int f8(pair *p) { return two(p->b, use(p)); }         /* found */
int f9(int x) { return two(take(&x), look(&x)); }     /* found */
int f10(int *b) { return two(take(b), b[1]); }        /* found */
int f11(int x) { int v[3] = {0}; v[x] = take(&x); return *v; } /* found */
int f12(int x) { x += take(&x); return x; }           /* found */
int f13(int i) { return two(i++, i); }                /* found */
int f14(int x) { return two((x = 3), x); }            /* found */
int f15(int *x) { return two(hands_on(x), *x); }      /* found */
int f16(void) { return two(use(&state), state.b); }   /* found */
__attribute__((hot)) int f17(int x) { return two(take(&x), (int)(x + 1.0)); } /* found */
int f18(int x) { int at = 0; sink(x, role(x, 7, &at)->a, at); return x; } /* found */
int f19(void) { int v[2]; return two(take(v), v[0]); } /* found */
int g1(int x) { x = take(&x); return x; }
int g2(int x) { return take(&x) && x; }
int g3(int x) { return take(&x), x; }
int g4(int x) { return two(look(&x), x); }
int g5(pair *p) { return two(take(&p->a), p->b); }
int g6(int x) { sink(x, &x); return x; }
int g7(int x) { int y = take(&x) ? x : 1; return y; }
int g8(int *x) { return two(take(x), sizeof *x); }
int g9(pair *p) { return two(use(p), p != 0); }
int g10(int *x) { return two(first(x), *x); }
int g11(int x, int y) { return two(take(&x), take(&y)); }
END
grep -n '/\* found \*/' "$folder/known.c" | cut -d: -f1 >"$folder/expected"
"$python3" tests/unsequenced.py "$folder/known.c" >"$folder/said"
cut -d: -f2 "$folder/said" | sort -n -u >"$folder/found"
cmp -s "$folder/expected" "$folder/found" || {
  echo "FAILED: of the known lines, those with < were missed, those with > are no mistake:"
  diff "$folder/expected" "$folder/found"
  failed=1
}

tops=lib
[ "${ETHD_UNSEQUENCED:-}" != all ] || tops='lib drivers apps tests'
# What needs headers that may be absent stays out: two examples, firmware, its simulator, peers, a stand-in for Xenomai.
files=$(find $tops -name '*.c' ! -name mujoco_arm.c ! -name mesh.c ! -path '*/firmware/*' ! -path '*/bench/peers/*' ! -path 'tests/simavr/*' ! -path 'tests/xenomai/*')
"$python3" tests/unsequenced.py $files >"$folder/said"
code=$?
[ $code = 0 ] || [ $code = 3 ] || { echo "FAILED: tests/unsequenced.py: exit $code"; failed=1; }
if [ -s "$folder/said" ]; then
  cat "$folder/said"
  echo "FAILED: write each of them as a statement of its own"
  failed=1
fi
echo "$(echo "$files" | wc -l) files of $tops"
exit $failed
