"""Runs ./docs/run as a reader would, but for making the site; and counts what README.md turns."""

import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SERVE = [sys.executable, "-B", ROOT / "docs/site/serve.py"]


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


def leave_in_the_middle(port: int, path: str) -> None:
    with socket.create_connection(("127.0.0.1", port), timeout=60) as reader:
        reader.sendall(f"GET {path} HTTP/1.0\r\n\r\n".encode())
        reader.recv(1)
    time.sleep(1)  # for the server to notice


class DocsRun(unittest.TestCase):
    def test_help(self) -> None:
        shown = subprocess.run([ROOT / "docs/run", "--help"], capture_output=True, encoding="utf-8")
        self.assertEqual((shown.returncode, shown.stderr), (0, ""))
        self.assertIn("./docs/run --serve [PORT]", shown.stdout)

    def expect_error(self, command: list, status: int, text: str) -> None:
        shown = subprocess.run(command, capture_output=True, encoding="utf-8", timeout=60)
        self.assertEqual((shown.returncode, shown.stdout), (status, ""), command)
        self.assertRegex(shown.stderr, rf"^error: .*{text}.*\n$")

    def test_wrong_usage(self) -> None:
        for arguments, text in (
            (["--sevre"], "--sevre"),
            (["lessons", "01"], "lessons 01"),
            (["--serve", "80", "90"], "--serve 80 90"),
            (["--serve", "first"], "'first'"),
            (["--serve", "0"], "'0'"),
            (["--serve", "65536"], "'65536'"),
        ):
            self.expect_error([ROOT / "docs/run", *arguments], 2, text)

    def test_busy_port(self) -> None:
        with socket.create_server(("127.0.0.1", 0)) as other:
            port = str(other.getsockname()[1])
            self.expect_error([*SERVE, ROOT, port], 1, f"port {port}: .* --serve PORT")

    def test_serves_this_machine_alone_until_interrupted(self) -> None:
        port = free_port()
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "index.html").write_text("the site")
            Path(folder, "large.js").write_bytes(bytes(20_000_000))
            command = [*SERVE, folder, str(port)]
            pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "encoding": "utf-8"}
            with subprocess.Popen(command, **pipes) as server:
                try:
                    self.assertIn(f"http://127.0.0.1:{port}/", server.stdout.readline())
                    with urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=60) as page:
                        self.assertEqual(page.read(), b"the site")
                    leave_in_the_middle(port, "/large.js")
                    # What listens at all addresses of a machine answers at this one, too.
                    with self.assertRaises(ConnectionRefusedError):
                        socket.create_connection(("127.0.0.2", port), timeout=60)
                finally:
                    server.send_signal(signal.SIGINT)
                out, err = server.communicate(timeout=60)
            self.assertEqual((server.returncode, out, err), (0, "", ""))


class Turn(unittest.TestCase):
    def test_it_is_one_turn_of_at_most_3_mb(self) -> None:
        webp = (ROOT / "docs/turn.webp").read_bytes()
        self.assertLessEqual(len(webp), 3_000_000)
        # A RIFF file: after 12 bytes, chunks of a name, a length and so many bytes, made even.
        frames, at = 0, 12
        while at < len(webp):
            length = int.from_bytes(webp[at + 4 : at + 8], "little")
            frames += webp[at : at + 4] == b"ANMF"
            at += 8 + length + length % 2
        readme = (ROOT / "README.md").read_text(encoding="utf-8")
        self.assertIn(f"./lessons/run 14 --frames {frames} ", readme)


if __name__ == "__main__":
    unittest.main()
