"""The build of the mutants: all of lib and the ring's decoder as one shared library under the tests."""
import math
import os
import resource
import subprocess
from pathlib import Path

DECODER = "drivers/proximity_ring/decoder.c"


class Tree:
    """A separate build with all of lib as one shared library."""

    def __init__(self, build):
        self.build = Path(build).resolve()
        self.work = self.build / "mutant"
        self.overlay = self.work / "src"
        self.env = dict(os.environ, CCACHE_DISABLE="1", BUILD=str(self.build), LD_LIBRARY_PATH=str(self.work))
        self.env.setdefault("ETHD_MOTION_DIR", "tests/motion")
        self.env.setdefault("ETHD_SCENE_QUERIES", "300")
        text = (self.build / "flags").read_text().splitlines()
        flags = next(line for line in text if " | " in line).split(" | ")
        self.link, self.flags_lib, self.flags_drivers = (f.split() for f in flags[:3])
        self.sources = sorted(str(p) for p in Path("lib").rglob("*.c")) + [DECODER]
        self.headers = sorted(str(p) for p in Path("lib").rglob("*.h"))

    def object(self, source):
        return self.build / "obj" / (source[:-2] + ".o")

    def users(self, header):
        """The sources that see a header, as the compiler said."""
        return [s for s in self.sources if header in self.object(s).with_suffix(".d").read_text().split()]

    def compile(self, source, text_at, out):
        flags = self.flags_drivers if source.startswith("drivers") else self.flags_lib
        overlay = ["-I" + str(self.overlay / "lib")]
        room = ["-I" + str(Path(source).parent)]
        limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (30, 30))
        return subprocess.run([self.link[0], *overlay, *flags, *room, "-Wno-error", "-Werror=implicit-function-declaration", "-c", str(text_at), "-o", str(out)], env=self.env,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=limit).returncode == 0

    def link_library(self, changed):
        objects = [str(changed.get(s, self.object(s))) for s in self.sources]
        return subprocess.run([*self.link, "-shared", "-o", str(self.work / "libmutant.so"), *objects, "-lm", "-ldl"],
                              env=self.env, stderr=subprocess.DEVNULL).returncode == 0

    def link_tests(self):
        libs = subprocess.run(["pkg-config", "--libs", "check"], capture_output=True, text=True).stdout.split()
        tests = {}
        for test in sorted(Path("tests").glob("*/test_*.c")):
            program = self.work / "tests" / test.stem
            program.parent.mkdir(parents=True, exist_ok=True)
            archives = [str(self.build / f"libethd-{part}.a") for part in ("tests", "apps", "drivers")]
            subprocess.run([*self.link, "-rdynamic", "-o", str(program), str(self.build / "obj" / test.with_suffix(".o")),
                            "-L" + str(self.work), "-Wl,--no-as-needed", "-lmutant", *archives, "-lmutant", *libs,
                            "-Wl,--as-needed", "-lSDL2_ttf", "-lSDL2", "-linih", "-lmodbus", "-lz", "-lexpat", "-lm", "-ldl",
                            "-lpthread"], env=self.env, check=True)
            tests[test.stem] = test
        return tests

    def link_programs(self):
        """What the golden outputs come from, before the library of mutants."""
        share = self.work / "share"
        share.unlink(missing_ok=True)
        share.symlink_to(self.build / "share")
        (self.work / "bin").mkdir(exist_ok=True)
        for name in ("ethd-tap", "ethd-replay"):
            archives = [str(self.build / f"libethd-{part}.a") for part in ("apps", "drivers")]
            subprocess.run([*self.link, "-rdynamic", "-o", str(self.work / "bin" / name), str(self.build / f"obj/apps/{name}.o"),
                            "-L" + str(self.work), "-Wl,--no-as-needed", "-lmutant", *archives, "-lmutant", "-linih",
                            "-lmodbus", "-lz", "-lexpat", "-lm", "-ldl", "-lpthread"], env=self.env, check=True)

    def golden(self):
        env = dict(self.env, BUILD=str(self.work), TMPDIR=str(self.work / "tmp"))
        limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (20, 21))
        try:
            return subprocess.run(["timeout", "-k", "1", "300", "sh", "tests/golden.sh", "once"], env=env, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=limit).returncode == 0
        except subprocess.SubprocessError:
            return False

    def run(self, test, seconds, fork):
        """(passed, s of processor time)"""
        def limit():
            resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(seconds), math.ceil(seconds) + 1))
            resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
            resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 30, 1 << 30))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        env = dict(self.env, CK_FORK="yes" if fork else "no", TMPDIR=str(self.work / "tmp"))
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        child = subprocess.Popen([str(self.work / "tests" / test)], env=env, stdin=subprocess.DEVNULL,
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=limit, start_new_session=True)
        try:
            code = child.wait(timeout=30 + 20 * seconds)
        except subprocess.TimeoutExpired:
            code = -9
        try:
            os.killpg(child.pid, 9)
        except ProcessLookupError:
            pass
        child.wait()
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return code == 0, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
