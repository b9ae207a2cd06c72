"""Pictures of a notebook: data URIs, attachments, files beside it."""

import base64
import binascii
import re
from pathlib import Path
from urllib.parse import unquote, unquote_to_bytes

from notebook_reports.export.errors import CannotShow
from notebook_reports.export.model import Picture
from notebook_reports.export.read.sanitise import drawing

KINDS = {
    "image/svg+xml": "svg",
    "image/png": "png",
    "image/jpeg": "jpg",
    "image/gif": "gif",
    "image/webp": "webp",
}
MIME = {kind: mime for mime, kind in KINDS.items()}
_SUFFIXES = {".svg": "svg", ".png": "png", ".jpg": "jpg", ".jpeg": "jpg", ".gif": "gif", ".webp": "webp"}
_FIRST_BYTES = {"png": b"\x89PNG\r\n\x1a\n", "jpg": b"\xff\xd8\xff", "gif": b"GIF8", "webp": b"RIFF"}
_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+:")


def from_bundle(mime: str, content: str, alt: str, width: float | None = None, height: float | None = None) -> Picture:
    """A picture of an output or attachment: SVG as text, the others in base64."""
    kind = KINDS[mime]
    content = "".join(content) if isinstance(content, list) else content
    if kind == "svg" and "<" in content:
        data = content.encode()
    else:
        data = _base64(content)
    return checked(Picture(data, kind, alt, width, height))


def from_url(
    url: str, alt: str, attachments: dict[str, dict[str, str]], folder: Path | None, root: Path | None
) -> Picture:
    """The picture a Markdown cell names. root: the folder below which files are shown, default `folder`.

    Raises CannotShow where there is none, or where it lies elsewhere: a report shows nothing of the machine that made
    it but what its project holds.
    """
    if url.startswith("data:"):
        mime, _, content = url[5:].partition(",")
        mime, *options = mime.split(";")
        if mime not in KINDS:
            told = f"its type is {mime or 'unknown'}"
            raise CannotShow(
                f"an image of type {mime or 'unknown'}; use SVG, PNG, JPEG, GIF or WebP", "image", told, alt
            )
        data = _base64(unquote(content)) if "base64" in options else unquote_to_bytes(content)
        return checked(Picture(data, KINDS[mime], alt))
    if url.startswith("attachment:"):
        name = unquote(url[len("attachment:") :])
        bundle = attachments.get(name) or {}
        for mime in KINDS:
            if mime in bundle:
                return from_bundle(mime, bundle[mime], alt)
        raise CannotShow(
            f"the image attachment {name!r} is missing; paste the image into the cell again",
            "image",
            "its attachment is missing from the notebook",
            alt,
            url,
        )
    if _SCHEME.match(url) or url.startswith("//"):
        raise CannotShow(
            f"the image {url} is on the network; save it beside the notebook and name the file",
            "image",
            "it is on the web, not in the notebook",
            alt,
            url,
        )
    if folder is None:
        raise CannotShow(f"the image {url} is a file, but the notebook's folder is not known", "image", "", alt, url)
    path = Path(folder) / unquote(url.partition("?")[0])
    kind = _SUFFIXES.get(path.suffix.lower())
    if kind is None:
        told = f"the image {url} is none of {', '.join(sorted(_SUFFIXES))}"
        raise CannotShow(told, "image", "a page cannot show a file of its kind", alt, url)
    try:
        if not path.resolve().is_relative_to(Path(root or folder).resolve()):
            told = f"the image {url} lies outside of {Path(root or folder).name}/; copy it beside the notebook"
            raise CannotShow(told, "image", "it is a file outside of the project", alt, url)
        if not path.is_file():
            raise FileNotFoundError(path)
        data = path.read_bytes()
    except CannotShow:
        raise
    except (OSError, ValueError, RuntimeError):
        raise CannotShow(
            f"no image {url}; it is looked for beside the notebook",
            "image",
            "there is no such file beside the notebook",
            alt,
            url,
        ) from None
    return checked(Picture(data, _kind_of(data) or kind, alt))


def _kind_of(data: bytes) -> str:
    """The kind that the first bytes tell; files are often named otherwise."""
    return next((kind for kind, first in _FIRST_BYTES.items() if data.startswith(first)), "")


def checked(picture: Picture) -> Picture:
    """The same picture, if its bytes are what its type says."""
    if picture.kind == "svg":
        picture.data = drawing(picture.data)
    elif not picture.data.startswith(_FIRST_BYTES[picture.kind]):
        told = f"an image that says it is {picture.kind.upper()} and is not"
        raise CannotShow(told, "image", "its data is damaged", picture.alt)
    return picture


def _base64(content: str) -> bytes:
    try:
        return base64.b64decode("".join(content.split()), validate=True)
    except binascii.Error:
        raise CannotShow("an image whose data is damaged; run the cell again", "image", "its data is damaged") from None
