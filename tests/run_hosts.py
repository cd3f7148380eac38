"""ethd-run beside what a shell, a terminal or a script does with it. usage: run_hosts.py BIN_FOLDER FOLDER"""
import fcntl, os, pty, re, select, signal, subprocess, sys, time

bin_, folder = sys.argv[1:]
run = bin_ + "/ethd-run"
WAIT = 60  # s: it only finds what hangs
failed = []


def check(good, *what):
    if not good:
        failed.append(what)
        print("FAILED", *what)


def ticks(name):
    """Returns how many the recording has so far."""
    path = folder + "/" + name + "/tick.npy"
    return os.path.getsize(path) // 776 if os.path.exists(path) else 0


# ---- job control: in the background of a shell that goes on, in the foreground, Ctrl-Z ----


class Shell:
    def __init__(self):
        self.pid, self.fd = pty.fork()
        if self.pid == 0:
            os.environ.update(PS1="READY> ", HISTFILE="/dev/null", TERM="dumb")
            os.execvp("bash", ["bash", "--norc", "-i"])
        self.said = ""

    def type(self, text):
        os.write(self.fd, text.encode())

    def see(self, pattern):
        """Waits for the pattern in what comes from now on, and returns what matched; None: it didn't come."""
        end = time.time() + WAIT
        while time.time() < end:
            found = re.search(pattern, self.said)
            if found:
                self.said = self.said[found.end():]
                return found.group()
            if select.select([self.fd], [], [], 0.1)[0]:
                self.said += os.read(self.fd, 65536).decode(errors="replace")
        return None


def state(pid):
    with open("/proc/%d/stat" % pid) as stat:
        return stat.read().rsplit(") ", 1)[1][0]


sh = Shell()
sh.see("READY> ")
sh.type(run + " --duration 600 --record " + folder + "/background &\n")
check(sh.see(r"\[1\] \d+"), "no job")
sh.type("echo job $!\n")
job = int(sh.see(r"job \d+").split()[1])
end = time.time() + WAIT
while ticks("background") < 500 and time.time() < end:
    time.sleep(0.05)
sh.type("echo typed $((1 + 1))\n")
check(sh.see("typed 2"), "the shell doesn't go on")
before = ticks("background")
while ticks("background") < before + 500 and state(job) != "T" and time.time() < end:
    time.sleep(0.05)
check(ticks("background") >= before + 500, "in the background of a terminal it stops: state", state(job))
sh.type("fg\n")
sh.type("status\n")
check(sh.see("ok: t .* enabled"), "no answer in the foreground:", sh.said)
sh.type("\x1a")
check(sh.see("Ctrl-Z is ignored: a stopped program can't control the device"), "Ctrl-Z:", sh.said)
sh.type("status\n")
check(sh.see("ok: t .* enabled"), "no answer after Ctrl-Z:", sh.said)
sh.type("stop\n")
check(sh.see("ok: stopping") and sh.see("READY> "), "no end:", sh.said)
sh.type("exit\n")
os.waitpid(sh.pid, 0)
os.close(sh.fd)

# ---- what is ignored when the program starts stays ignored: nohup, and a script's & ----


def start(arguments, ignored, **streams):
    def ignore():
        for number in (signal.SIGINT, signal.SIGHUP, signal.SIGQUIT):
            signal.signal(number, signal.SIG_IGN if number in ignored else signal.SIG_DFL)

    return subprocess.Popen(arguments, preexec_fn=ignore, **streams)


ignored = (signal.SIGINT, signal.SIGHUP, signal.SIGQUIT)
p = start([run, "--duration", "600"], ignored, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
for number in (None,) + ignored:
    if number:
        p.send_signal(number)
        time.sleep(0.1)
    p.stdin.write("status\n")
    p.stdin.flush()
    check(" enabled, " in p.stdout.readline(), "ended or stopped by", number, "which it was told to ignore")
p.terminate()
p.communicate()
p = start([bin_ + "/ethd-tap", "--taps", "1000000"], (signal.SIGINT,), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
time.sleep(1)
p.send_signal(signal.SIGINT)
time.sleep(1)
check(p.poll() is None, "ethd-tap is ended by SIGINT, which it was told to ignore")
p.terminate()
p.wait()

# ---- nobody reads: the run goes on, and ends when it is told ----


def full_pipe():
    ends = os.pipe()
    flags = fcntl.fcntl(ends[1], fcntl.F_GETFL)
    fcntl.fcntl(ends[1], fcntl.F_SETFL, flags | os.O_NONBLOCK)
    for piece in (4096, 1):
        try:
            while True:
                os.write(ends[1], bytes(piece))
        except BlockingIOError:
            pass
    fcntl.fcntl(ends[1], fcntl.F_SETFL, flags)
    return ends


def unread(name, arguments, told, both=False):
    """Returns what it says on stderr, if that isn't the same pipe."""
    ends = full_pipe()
    words = folder + "/" + name + ".err"
    with open(words, "w") as err:
        p = start(arguments, (), stdin=subprocess.PIPE, stdout=ends[1], stderr=ends[1] if both else err)
    os.close(ends[1])
    if told:
        p.stdin.write(b"status\n" * 5000)
        p.stdin.flush()
        end = time.time() + WAIT
        while ticks(name) < 2000 and time.time() < end:
            time.sleep(0.05)
        p.send_signal(told)
    try:
        code = p.wait(WAIT)
        check(code == 1, name, "exit", code)
    except subprocess.TimeoutExpired:
        check(False, name, "doesn't end")
        p.kill()
    os.close(ends[0])
    return open(words).read()


for both in (False, True):
    name = "both" if both else "unread"
    said = unread(name, [run, "--duration", "600", "--record", folder + "/" + name], signal.SIGTERM, both)
    events = open(folder + "/" + name + "/events.csv").read()
    check(",fault," not in events and ",end,closed" in events, name, events)
    check(both or re.search(r"standard output: its reader is too slow, and \d+ bytes are lost", said), name, said)
said = unread("latency", [bin_ + "/ethd-latency", "--alone", "--duration", "0.3"], None)
check(re.search(r"its reader is too slow, and \d+ bytes are lost", said), said)

sys.exit(len(failed) > 0)
