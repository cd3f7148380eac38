"""Makes ethd._native from libethd's own headers: nothing of them is repeated here.

The library is the build folder that ETHD_BUILD names, else the installed one that pkg-config finds, else ../../build. Its
archives go into the module, which then needs no search path and keeps the version that it was made with.
"""
import os
import re
import shlex
import subprocess

from cffi import FFI

HERE = os.path.dirname(os.path.abspath(__file__))
TREE = os.path.dirname(os.path.dirname(HERE))
NEEDED = ["-linih", "-ljansson", "-lmodbus", "-lm", "-ldl", "-lpthread"]


def pkg_config(*arguments):
    run = subprocess.run([os.environ.get("PKG_CONFIG", "pkg-config"), *arguments], stdout=subprocess.PIPE, text=True)
    return run.stdout.strip() if run.returncode == 0 else None


def in_build(folder):
    """Returns (include folder, archives' folder, further link flags) of a build folder."""
    if not os.path.exists(os.path.join(folder, "libethd-drivers.a")):
        raise SystemExit(f"{folder}: there is no libethd-drivers.a; run make, or install libethd where pkg-config finds it (PKG_CONFIG_PATH)")
    # this file's tree, or the one of the build folder where this file was unpacked elsewhere
    includes = [os.path.join(tree, "include") for tree in (TREE, os.path.dirname(folder))]
    for include in includes:
        if os.path.exists(os.path.join(include, "ethd", "ethd.h")):
            return include, folder, NEEDED
    raise SystemExit(f"{folder}: there are no headers in {' or '.join(includes)}; install libethd where pkg-config finds it")


def library():
    if os.environ.get("ETHD_BUILD"):
        return in_build(os.path.abspath(os.environ["ETHD_BUILD"]))
    try:
        libdir = pkg_config("--variable=libdir", "ethd-drivers")
    except FileNotFoundError:
        libdir = None
    if libdir:
        needed = shlex.split(pkg_config("--static", "--libs", "ethd-drivers"))
        own = ("-lethd", "-lethd-drivers", "-L" + libdir)
        return pkg_config("--variable=includedir", "ethd-drivers"), libdir, [flag for flag in needed if flag not in own]
    return in_build(os.path.join(TREE, "build"))


def version(of):
    with open(os.path.join(of[0], "ethd", "ethd.h")) as file:
        return re.search(r'define ETHD_VERSION "(.*)"', file.read()).group(1)


def headers(include):
    names = sorted(os.listdir(os.path.join(include, "ethd")))
    return "".join(f"#include <ethd/{name}>\n" for name in names if name.endswith(".h"))


def without_bodies(text):
    """Declares inline functions as all others, since cffi can't parse them; their bodies stay in the headers."""
    out, at = [], 0
    for match in re.finditer(r"static\s+inline\b([^{};]*)([{;])", text):
        if match.start() < at:
            continue
        out.append(text[at:match.start()])
        at = match.end()
        depth = 1 if match.group(2) == "{" else 0
        while depth:
            depth += {"{": 1, "}": -1}.get(text[at], 0)
            at += 1
        if match.group(2) == "{":
            out.append(match.group(1) + ";")
    return "".join(out) + text[at:]


def declarations(include):
    """Returns what our headers declare, preprocessed, without attributes."""
    compiler = shlex.split(os.environ.get("CC", "cc"))
    command = [*compiler, "-E", "-std=gnu11", "-I" + include, "-D__attribute__(x)=", "-x", "c", "-"]
    text = subprocess.run(command, input=headers(include), stdout=subprocess.PIPE, text=True, check=True).stdout
    ours, kept = False, []
    for line in text.splitlines():
        marker = re.match(r'# \d+ "(.*?)"', line)
        if marker:
            ours = os.path.dirname(os.path.realpath(marker.group(1))) == os.path.realpath(os.path.join(include, "ethd"))
        elif ours:
            kept.append(line)
    text = without_bodies("\n".join(kept))
    text = re.sub(r"_Static_assert\s*\(.*?\)\s*;", "", text, flags=re.S)
    # plugins define these, the library doesn't
    return re.sub(r"extern\s+const (ethd_plugin_entry ethd_plugin|ethd_driver ethd_driver_plugin);", "", text)


# Steps and queries over arrays. Programs that ask scenes set flush-to-zero first; here it holds for the call alone.
HELPERS = """
static uint64_t flush(void) {
#if defined(__SSE2__)
  uint64_t was = __builtin_ia32_stmxcsr();
  __builtin_ia32_ldmxcsr((unsigned)was | 0x8040);
#elif defined(__aarch64__)
  uint64_t was;
  __asm__ volatile("mrs %0, fpcr" : "=r"(was));
  __asm__ volatile("msr fpcr, %0" : : "r"(was | 1 << 24));
#else
  uint64_t was = 0;
#endif
  return was;
}
static void restore(uint64_t was) {
#if defined(__SSE2__)
  __builtin_ia32_ldmxcsr((unsigned)was);
#elif defined(__aarch64__)
  __asm__ volatile("msr fpcr, %0" : : "r"(was));
#else
  (void)was;
#endif
}
static int python_step(ethd_control *control, const char *sense, ethd_command *command, char *trace) {
  ethd_sense in;
  ethd_trace out;
  memcpy(&in, sense, sizeof in);
  memset(&out, 0, sizeof out);
  int status = ethd_control_step(control, &in, command, &out);
  memcpy(trace, &out, sizeof out);
  return status;
}
static int python_space_step(ethd_space *space, const char *sense, const char *surfaces, uint32_t count,
                             ethd_space_command *command, char *trace) {
  ethd_space_sense in;
  ethd_space_trace out;
  ethd_surface near[ETHD_SURFACES_MAX + 1];
  if (count > ETHD_SURFACES_MAX) count = ETHD_SURFACES_MAX + 1; /* which a step refuses */
  memcpy(&in, sense, sizeof in);
  memcpy(near, surfaces, count * sizeof *near);
  memset(&out, 0, sizeof out);
  int status = ethd_space_step(space, &in, near, count, command, &out);
  memcpy(trace, &out, sizeof out);
  return status;
}
static size_t python_surfaces(const ethd_solids *solids, const double *x, double range, char *out, size_t room) {
  ethd_surface near[ETHD_SURFACES_MAX];
  ethd_vec3 at = {x[0], x[1], x[2]};
  uint64_t was = flush();
  size_t found = ethd_solids_surfaces(solids, NULL, at, range, near, room < ETHD_SURFACES_MAX ? room : ETHD_SURFACES_MAX);
  restore(was);
  if (found > room) found = room;
  memcpy(out, near, found * sizeof *near);
  return found;
}
static void python_nearest(const ethd_scene *scene, size_t count, const double *points, double *distance, double *normal,
                           int32_t *object) {
  ethd_scene_hint hint = {0};
  uint64_t was = flush();
  for (size_t i = 0; i < count; i++) {
    ethd_nearest found;
    ethd_vec x;
    memcpy(&x, points + 2 * i, 2 * sizeof *points);
    ethd_scene_query_near(scene, x, &hint, &found);
    distance[i] = found.distance;
    memcpy(normal + 2 * i, &found.n, 2 * sizeof *normal);
    object[i] = found.object;
  }
  restore(was);
}
"""
HELPERS_DECLARED = """
static char *const ETHD_VERSION;
#define ETHD_SURFACES_MAX ...
#define ETHD_NEAR_REFUSED ...
int python_step(ethd_control *control, const char *sense, ethd_command *command, char *trace);
int python_space_step(ethd_space *space, const char *sense, const char *surfaces, uint32_t count,
                      ethd_space_command *command, char *trace);
size_t python_surfaces(const ethd_solids *solids, const double *x, double range, char *out, size_t room);
void python_nearest(const ethd_scene *scene, size_t count, const double *points, double *distance, double *normal,
                    int32_t *object);
"""


def make():
    include, libdir, needed = library()
    ffi = FFI()
    ffi.cdef(declarations(include) + HELPERS_DECLARED)
    archives = [os.path.join(libdir, name) for name in ("libethd-drivers.a", "libethd.a")]
    ffi.set_source(
        "ethd._native",
        "#include <string.h>\n" + headers(include) + HELPERS,
        include_dirs=[include],
        # the whole library, for plugins that call it
        extra_link_args=[archives[0], "-Wl,--whole-archive", archives[1], "-Wl,--no-whole-archive", *needed],
        depends=archives,
    )
    return ffi


ffi = make()
