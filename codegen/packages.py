"""What makes an exported folder a package: CMake, pkg-config, PlatformIO, Arduino and Zephyr."""

from __future__ import annotations

import json
import re
from typing import Any

from ..symbolic.block import Block
from .emit import generator_version, templates
from .options import Options
from .style import comment_safe

PAGE = "https://example.invalid/{name}"
"""Arduino's format asks for a page. It is the user's to have; a name that is nobody's holds its place."""

NAMES_OF_CMAKE = frozenset(
    "all clean depend edit_cache help install package package_source preinstall rebuild_cache test".split()
)
"""Targets that CMake's generators make themselves: no target of ours may be called so."""

LONGEST_SENTENCE = 200
"""Characters of a description: what every registry takes."""


def release_of(version: str) -> str:
    """Return the three numbers at the start of a version, which CMake and Arduino take: 0.0.0 if there are none.

    Parameters
    ----------
    version : str
        A version of Python's kind, such as ``1.2rc1`` or ``0+unknown``.
    """
    start = re.match(r"\d+(?:\.\d+){0,2}", version)
    numbers = [str(int(item)) for item in start[0].split(".")] if start else []
    return ".".join([*numbers, "0", "0", "0"][:3])


def sentence_of(block: Block) -> str:
    """Return what a block is, on one line that every manifest takes: the beginning of its docstring."""
    words = comment_safe(block.doc or f"{block.name}, a component of discrete time").replace("\\", "/")
    # a '$' or a '#' means something to make, CMake and pkg-config
    words = re.sub(r"[$#@;]", " ", words)
    if len(words) > LONGEST_SENTENCE:
        words = words[: LONGEST_SENTENCE - 4].rsplit(" ", 1)[0] + " ..."
    return words.strip() or block.name


def package_files(block: Block, options: Options, context: dict[str, Any]) -> dict[str, str]:
    """Return path in the folder -> text of the files by which others build the library.

    Parameters
    ----------
    block : Block
        What is exported.
    options : Options
        The choices; contraction becomes the default of every build.
    context : dict
        What the example's template gets: name, entry, inputs, outputs, params.

    Returns
    -------
    dict
        The same bytes for the same model and generator, anywhere.
    """
    name = block.name
    given = {
        **context,
        "release": release_of(generator_version()),
        "sentence": sentence_of(block),
        "contraction": "fast" if options.contract else "off",
        "url": PAGE.format(name=name),
        "target": f"{name}_library" if name in NAMES_OF_CMAKE else name,
    }
    rendered = {
        "CMakeLists.txt": "CMakeLists.txt.j2",
        f"cmake/{name}Config.cmake.in": "Config.cmake.in.j2",
        f"cmake/{name}.pc.in": "pc.in.j2",
        "library.properties": "library.properties.j2",
        f"examples/{name}/{name}.ino": "example.ino.j2",
        "zephyr/module.yml": "module.yml.j2",
        "zephyr/CMakeLists.txt": "zephyr.cmake.j2",
        "zephyr/Kconfig": "Kconfig.j2",
    }
    files = {path: templates().get_template(f"packages/{file}").render(**given) for path, file in rendered.items()}
    return {**files, "library.json": _library_json(block, given)}


def _library_json(block: Block, given: dict[str, Any]) -> str:
    """Return the manifest of PlatformIO. It has no licence: the field is optional, and the C belongs to its user."""
    name = block.name
    manifest = {
        "name": name,
        "version": f"{given['release']}+{block.model_hash()}",
        "description": given["sentence"],
        "keywords": ["generated", "plantc"],
        "frameworks": "*",
        "platforms": "*",
        "headers": f"{name}.h",
        "build": {
            "srcDir": "src",
            "includeDir": "src",
            "flags": [f"-ffp-contract={given['contraction']}", "-fno-math-errno"],
        },
        "examples": [
            {"name": name, "base": f"examples/{name}", "files": [f"{name}.ino"]},
            {"name": f"{name}_main", "base": "examples", "files": ["example_main.c"]},
        ],
    }
    return json.dumps(manifest, indent=2) + "\n"
