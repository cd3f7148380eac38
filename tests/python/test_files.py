"""Files that the programs in Python read and write."""
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from ethd_programs.cli import Refusal
from ethd_programs.files import Output, opened, there


def put(path: object, text: bytes = b"new", received: object = None) -> None:
    with Output(str(path), received and str(received)) as file:
        file.write(text)


def refuses(words: str, path: object, **options: object) -> None:
    with pytest.raises(Refusal) as e:
        put(path, **options)
    assert words in str(e.value) and e.value.code == 1


def test_replaces_a_regular_file_and_keeps_its_mode(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("old")
    path.chmod(0o640)
    put(path)
    assert path.read_bytes() == b"new" and path.stat().st_mode & 0o777 == 0o640
    assert os.listdir(tmp_path) == ["a.csv"]


def test_a_failure_leaves_what_was_there(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("old")
    with pytest.raises(ZeroDivisionError):
        with Output(str(path)) as file:
            file.write(b"half")
            file.write(b"%d" % (1 // 0))
    with pytest.raises(Refusal, match="a.csv: not written: stopped"):
        with Output(str(path)) as file:
            raise KeyboardInterrupt
    assert path.read_text() == "old" and os.listdir(tmp_path) == ["a.csv"]


def test_links(tmp_path: Path) -> None:
    (tmp_path / "real").write_text("old")
    (tmp_path / "link").symlink_to("real")
    put(tmp_path / "link")
    assert (tmp_path / "link").is_symlink() and (tmp_path / "real").read_text() == "new"
    (tmp_path / "nowhere").symlink_to("nothing")
    refuses("is a link that leads nowhere; remove it first", tmp_path / "nowhere")
    (tmp_path / "device").symlink_to("/dev/null")
    refuses("is a link to something that isn't a file", tmp_path / "device")
    refuses("is a folder, a file's name is needed", tmp_path)
    put("/dev/null")


def test_no_link_of_a_received_folder_is_followed(tmp_path: Path) -> None:
    mine, theirs = tmp_path / "mine", tmp_path / "theirs"
    mine.mkdir()
    theirs.mkdir()
    (mine / "thesis").write_text("mine")
    (theirs / "out.csv").symlink_to("../mine/thesis")
    (theirs / "sub").symlink_to("../mine")
    refuses("out.csv: is a link, which isn't followed", theirs / "out.csv", received=theirs)
    refuses("sub/thesis: is a link, which isn't followed", theirs / "sub" / "thesis", received=theirs)
    assert (mine / "thesis").read_text() == "mine" and os.listdir(mine) == ["thesis"]
    with pytest.raises(ValueError, match="out.csv: is a link"):
        opened(str(theirs), "out.csv")
    assert not there(str(theirs), "none")
    os.mkfifo(theirs / "pipe")
    with pytest.raises(ValueError, match="pipe: is a pipe, a file is needed"):
        opened(str(theirs), "pipe")


def test_a_pipe_is_written_through(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    writer = threading.Thread(target=put, args=(tmp_path / "pipe",))
    writer.start()
    assert (tmp_path / "pipe").read_bytes() == b"new"
    writer.join()


def test_what_a_killed_program_left_goes_and_what_another_writes_stays(tmp_path: Path) -> None:
    (tmp_path / "a.csv.123-0.new").write_text("left")
    (tmp_path / "a.csv.old.new").write_text("mine")
    with Output(str(tmp_path / "a.csv")) as file:
        file.write(b"1")
        other = "from ethd_programs.files import _remove_left; import sys; _remove_left(sys.argv[1], 'a.csv')"
        subprocess.run([sys.executable, "-c", other, str(tmp_path)], check=True)
    assert sorted(os.listdir(tmp_path)) == ["a.csv", "a.csv.old.new"]


def test_a_standard_stream_is_written_not_replaced(tmp_path: Path) -> None:
    code = "from ethd_programs.files import Output; import sys\nwith Output(sys.argv[1]) as f: f.write(b'x')"
    path = tmp_path / "out"
    for name in ("/dev/stdout", "/dev/fd/1", str(path)):
        with open(path, "w") as out:
            subprocess.run([sys.executable, "-c", code, name], check=True, stdout=out)
        assert path.read_text() == "x" and os.listdir(tmp_path) == ["out"]
    with open(os.devnull) as unwritable:
        run = subprocess.run([sys.executable, "-c", code, "/dev/stdout"], stdin=unwritable, stdout=unwritable, stderr=subprocess.PIPE)
    assert b"that descriptor isn't open for writing" in run.stderr
