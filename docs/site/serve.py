"""Serves a folder to browsers on this machine alone: serve.py FOLDER PORT."""

import contextlib
import functools
import sys
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from typing import IO


class QuietHandler(SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        """Nothing: the browser shows what is missing."""

    def end_headers(self) -> None:
        self.send_header("Cache-Control", "no-cache")  # ask first: the site may have been made anew
        super().end_headers()

    def copyfile(self, *files: IO[bytes]) -> None:
        with contextlib.suppress(ConnectionError):  # the reader has left the page
            super().copyfile(*files)


def main() -> None:
    folder, port = sys.argv[1], int(sys.argv[2])
    handler = functools.partial(QuietHandler, directory=folder)
    try:
        server = ThreadingHTTPServer(("127.0.0.1", port), handler)
    except OSError as error:
        sys.exit(f"error: port {port}: {error.strerror}; ./docs/run --serve PORT takes another one")
    try:
        print(f"The site: http://127.0.0.1:{port}/ (Ctrl+C ends this)", flush=True)
        server.serve_forever()
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
