"""What pip is told about package indexes on this machine, said to uv, which reads none of pip's configuration."""

import ast
import os
import subprocess

# pip's option: uv's variables, the separator of several. What is set for uv already stays.
TRANSLATION = {
    "index-url": ("UV_DEFAULT_INDEX", " "),
    "extra-index-url": ("UV_INDEX", " "),
    "find-links": ("UV_FIND_LINKS", ","),
    "trusted-host": ("UV_INSECURE_HOST", " "),
    "no-index": ("UV_NO_INDEX", " "),
    "timeout": ("UV_HTTP_TIMEOUT", " "),
    "default-timeout": ("UV_HTTP_TIMEOUT", " "),
    "cert": ("SSL_CERT_FILE", " "),
    "client-cert": ("SSL_CLIENT_CERT", " "),
    "proxy": ("ALL_PROXY", " "),
}
ALWAYS = {
    "UV_INDEX_STRATEGY": "unsafe-best-match",  # all indexes are asked, as pip does; the hashes decide what is safe
    "UV_SYSTEM_CERTS": "1",
    "UV_PYTHON_DOWNLOADS": "never",
    "UV_NO_PROGRESS": "1",
    "NO_COLOR": "1",
}


def pip_settings(listing):
    """The options of `pip config list`: {option: [values]}; environment before command before global.

    >>> pip_settings("global.index-url='a'\\n:env:.index-url='b'\\nglobal.find-links='c d'\\nglobal.cert=''")
    {'index-url': ['b'], 'find-links': ['c', 'd']}
    """
    found = {}
    for section in ("global", "install", ":env:"):
        for line in listing.splitlines():
            name, equals, value = line.partition("=")
            if equals and name.startswith(section + "."):
                found[name[len(section) + 1 :]] = str(ast.literal_eval(value)).split()
    return {name: values for name, values in found.items() if values}


def uv_environment(python):
    """The environment variables for uv, from those of this process and the configuration of an interpreter's pip."""
    command = [python, "-m", "pip", "config", "list", "--disable-pip-version-check"]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    said = {}
    for option, values in pip_settings(done.stdout.decode("utf-8", "replace")).items():
        if option in TRANSLATION:
            name, separator = TRANSLATION[option]
            said[name] = separator.join(values)
    return {**said, **ALWAYS, **os.environ}
