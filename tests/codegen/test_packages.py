"""An exported folder as others build it: by CMake and pkg-config, as a PlatformIO, Arduino and Zephyr package."""

import json
import os
import re
import shutil
import struct
import subprocess

import pytest
from plantc.codegen import package
from plantc.codegen.compiler import WARNINGS
from plantc.codegen.folder import files_in, write_files
from plantc.codegen.options import Options
from plantc.codegen.package import build_files, export
from plantc.codegen.packages import LONGEST_SENTENCE, release_of, sentence_of
from plantc.codegen.style import Precision
from plantc.codegen.views import NativeView
from plantc.examples.pendulum import pendulum_ekf
from plantc.symbolic import Block

NAME = "pendulum_ekf"
STEPS = 50

PROGRAM = """
#include "pendulum_ekf.h"

#include <stdio.h>
#include <string.h>

#ifdef __cplusplus
extern "C" int main(void);
#endif

int main(void)
{
    const pendulum_ekf_params_t params = PENDULUM_EKF_PARAMS_DEFAULT;
    pendulum_ekf_state_t state;
    int refused = (pendulum_ekf_init(&state, &params) < PENDULUM_EKF_OK);
    uint32_t bits = 0U;

    for (int k = 0; k < 50; k++)
    {
        const pendulum_ekf_predict_in_t moved = {0.0f, 0.01f};
        const pendulum_ekf_update_encoder_in_t read = {0.01f * (float)k};
        pendulum_ekf_update_encoder_out_t out;

        refused += (pendulum_ekf_predict(&state, &params, &moved) < PENDULUM_EKF_OK);
        refused += (pendulum_ekf_update_encoder(&state, &params, &read, &out) < PENDULUM_EKF_OK);
    }
    (void)memcpy(&bits, &state.FIRST, sizeof(bits));
    (void)printf("%s %08lx %d\\n", pendulum_ekf_model(), (unsigned long)bits, refused);
    return 0;
}
"""

PROJECT = """
cmake_minimum_required(VERSION 3.13)
project(user LANGUAGES @LANGUAGES@)
@TAKE@
foreach(language @LANGUAGES@)
    string(TOLOWER ${language} suffix)
    add_executable(user_${suffix} ${CMAKE_SOURCE_DIR}/user.${suffix} ${EXTRA_SOURCES})
    target_link_libraries(user_${suffix} PRIVATE pendulum_ekf::pendulum_ekf)
endforeach()
"""

TOOLCHAIN = """
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_C_FLAGS_INIT "-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard")
"""

CORTEX_M4 = "-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard".split()
MACHINE = "-M mps2-an386 -nographic -monitor none -serial none -semihosting-config enable=on,target=native".split()

STARTUP = """
#include <stdint.h>

extern uint32_t _stack_hi, _sidata, _sdata, _edata, _sbss, _ebss;
extern int main(void);
extern void exit(int status);
extern void initialise_monitor_handles(void);
extern void __libc_init_array(void);

void _init(void) {}
void _fini(void) {}

static void fault(void)
{
    __asm volatile("bkpt 0");
    for (;;) {}
}

__attribute__((noinline)) static void run(void)
{
    exit(main());
}

void reset(void)
{
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20; /* the FPU is off after reset */
    __asm volatile("dsb\\n isb");
    for (uint32_t *s = &_sidata, *d = &_sdata; d < &_edata;) *d++ = *s++;
    for (uint32_t *d = &_sbss; d < &_ebss;) *d++ = 0u;
    initialise_monitor_handles();
    __libc_init_array();
    run();
}

__attribute__((section(".isr_vector"), used)) static void (*const vectors[])(void) = {
    (void (*)(void)) & _stack_hi, reset, fault, fault, fault, fault, fault};
"""

SCRIPT = """
MEMORY {
  FLASH (rx)  : ORIGIN = 0x00000000, LENGTH = 1M
  RAM   (rwx) : ORIGIN = 0x20000000, LENGTH = 256K
}
ENTRY(reset)
SECTIONS {
  .text : { KEEP(*(.isr_vector)) *(.text*) *(.rodata*) . = ALIGN(4);
    __preinit_array_start = .; KEEP(*(.preinit_array*)) __preinit_array_end = .;
    __init_array_start = .; KEEP(*(SORT(.init_array.*))) KEEP(*(.init_array*)) __init_array_end = .;
    __fini_array_start = .; KEEP(*(.fini_array*)) __fini_array_end = .; } >FLASH
  .ARM.exidx : { __exidx_start = .; *(.ARM.exidx*) __exidx_end = .; } >FLASH
  .data : { . = ALIGN(4); _sdata = .; *(.data*) . = ALIGN(4); _edata = .; } >RAM AT>FLASH
  _sidata = LOADADDR(.data);
  .bss (NOLOAD) : { . = ALIGN(4); _sbss = .; *(.bss*) *(COMMON) . = ALIGN(4); _ebss = .; } >RAM
  end = .; _end = .;
  _stack_hi = ORIGIN(RAM) + LENGTH(RAM);
}
"""


def run(*command, fails=False, **more):
    """Run a command and return what it said; or what it said where it has to fail."""
    environment = {**os.environ, "LC_ALL": "C", **more}
    environment.pop("CMAKE_PREFIX_PATH", None)
    done = subprocess.run(
        [str(item) for item in command], capture_output=True, text=True, check=False, env=environment, timeout=300
    )
    assert (done.returncode != 0) == fails, done.stdout + done.stderr
    return done.stdout + done.stderr


def first_field():
    return pendulum_ekf.memory_group().members[0].name


def expected(steps=STEPS):
    """What the user's program has to print: the same calls through Python's view of the C."""
    view = NativeView(pendulum_ekf, "float")
    memory, params = view.memory(), view.params()
    memory = view.call("init", memory, view.inputs("init", {}), params).memory
    for k in range(steps):
        memory = view.call("predict", memory, view.inputs("predict", {"torque": 0.0, "dt": 0.01}), params).memory
        read = view.inputs("update_encoder", {"encoder": PACE * Precision("float").dtype(k)})
        memory = view.call("update_encoder", memory, read, params).memory
    (bits,) = struct.unpack("<I", struct.pack("<f", float(memory[first_field()])))
    return f"{pendulum_ekf.model_hash()} {bits:08x} 0"


PACE = Precision("float").dtype(0.01)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The folder of an export, as far as it follows from the model."""
    folder = tmp_path_factory.mktemp("export") / NAME
    write_files(folder, build_files(pendulum_ekf, "float"))
    return folder


@pytest.fixture
def folder(written, tmp_path):
    """A copy to change."""
    shutil.copytree(written, tmp_path / NAME)
    return tmp_path / NAME


def install(folder, prefix, *options):
    """Configure, build and install a package; return the folder of the build."""
    build = prefix.with_name(f"{prefix.name}-build")
    run("cmake", "-S", folder, "-B", build, f"-DCMAKE_INSTALL_PREFIX={prefix}", *options)
    run("cmake", "--build", build)
    run("cmake", "--install", build)
    return build


@pytest.fixture
def installed(needs, written):
    """Where the package was installed, for the host; built once."""
    needs("cmake", "cc", "c++")
    prefix = written.parent / "installed"
    if not prefix.exists():
        install(written, prefix)
    return prefix


def user_project(where, languages, take="find_package(pendulum_ekf 0.1 REQUIRED)"):
    """Write a user's project, in C, C++ or both (C CXX)."""
    where.mkdir()
    text = PROJECT.replace("@LANGUAGES@", languages).replace("@TAKE@", take)
    (where / "CMakeLists.txt").write_text(text)
    for suffix in ("c", "cxx"):
        (where / f"user.{suffix}").write_text(PROGRAM.replace("FIRST", first_field()))
    return where


# -- CMake and pkg-config ---------------------------------------------------------------------------------------------


def test_a_users_project_in_c_and_cpp_finds_the_installed_package(installed, tmp_path):
    project = user_project(tmp_path / "user", "C CXX")
    build = tmp_path / "build"
    run("cmake", "-S", project, "-B", build, f"-DCMAKE_PREFIX_PATH={installed}", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
    run("cmake", "--build", build)
    assert run(build / "user_c").strip() == run(build / "user_cxx").strip() == expected()
    assert expected(STEPS - 1) != expected()
    # what the package needs for itself stays with it
    commands = (build / "compile_commands.json").read_text()
    assert "-ffp-contract" not in commands
    assert str(installed / "include") in commands


def test_a_version_that_is_not_there_is_not_found(installed, tmp_path):
    for version, found in (("0.1", True), ("9.0", False)):
        project = user_project(tmp_path / version, "C", f"find_package(pendulum_ekf {version} REQUIRED)")
        build = tmp_path / f"build-{version}"
        said = run("cmake", "-S", project, "-B", build, f"-DCMAKE_PREFIX_PATH={installed}", fails=not found)
        assert found or "compatible with requested version" in " ".join(said.split())


def test_pkg_config_finds_what_was_installed_and_then_moved(installed, tmp_path, needs):
    needs("pkg-config")
    moved = tmp_path / "moved"
    shutil.copytree(installed, moved)
    project = user_project(tmp_path / "user", "C CXX")
    (description,) = moved.rglob(f"{NAME}.pc")
    where = {"PKG_CONFIG_PATH": str(description.parent)}
    flags = run("pkg-config", "--cflags", "--libs", NAME, **where).split()
    assert run("pkg-config", "--modversion", NAME, **where).strip() == release_of(package.generator_version())
    assert run("pkg-config", "--variable=model", NAME, **where).strip() == pendulum_ekf.model_hash()
    for compiler, source in (("cc", "user.c"), ("c++", "user.cxx")):
        run(compiler, project / source, *flags, "-o", tmp_path / "program")
        assert run(tmp_path / "program").strip() == expected()
    library = next(moved.rglob(f"lib{NAME}.a"))
    library.rename(library.with_suffix(".gone"))  # so it was this one, and no other
    run("cc", project / "user.c", *flags, "-o", tmp_path / "program", fails=True)


def test_a_project_that_takes_the_folder_in_builds_the_library_and_no_more(folder, tmp_path, needs):
    needs("cmake", "cc")
    project = user_project(tmp_path / "user", "C", f"add_subdirectory({folder} package)")
    build = tmp_path / "build"
    run("cmake", "-S", project, "-B", build)
    run("cmake", "--build", build)
    assert run(build / "user_c").strip() == expected()
    assert not list(build.rglob(f"{NAME}_test_vectors*"))


def test_ctest_runs_the_vectors_and_a_planted_mismatch_fails_it(folder, tmp_path, needs):
    needs("cmake", "ctest", "cc")
    build = tmp_path / "build"
    run("cmake", "-S", folder, "-B", build)
    run("cmake", "--build", build)
    assert "100% tests passed" in run("ctest", "--test-dir", build, "--no-tests=error")
    source = folder / f"src/{NAME}.c"
    changed = source.read_text().replace("delta[0] = ", "delta[0] = 1.1f * ", 1)
    assert changed != source.read_text()
    source.write_text(changed)
    run("cmake", "--build", build)
    assert f"{NAME}_vectors (Failed)" in run("ctest", "--test-dir", build, fails=True)


def test_contraction_is_chosen_and_stated(folder, tmp_path, needs):
    needs("cmake", "cc")
    export_commands = "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"
    for chosen in ("off", "fast"):
        build = tmp_path / chosen
        run("cmake", "-S", folder, "-B", build, export_commands, f"-DPENDULUM_EKF_CONTRACT={chosen}")
        commands = json.loads((build / "compile_commands.json").read_text())
        (library,) = [item["command"] for item in commands if item["file"].endswith(f"src/{NAME}.c")]
        assert f"-ffp-contract={chosen} -fno-math-errno" in library
    said = run("cmake", "-S", folder, "-B", tmp_path / "x", "-DPENDULUM_EKF_CONTRACT=on", fails=True)
    assert "set it to off or fast" in said
    exported = build_files(pendulum_ekf, Options(Precision("float"), contract=True))
    assert 'set(PENDULUM_EKF_CONTRACT "fast"' in exported["CMakeLists.txt"]
    assert json.loads(exported["library.json"])["build"]["flags"][0] == "-ffp-contract=fast"
    assert "default y" in exported["zephyr/Kconfig"]


def test_for_a_cortex_m4_the_users_project_is_linked_and_runs_with_the_same_bits(installed, folder, tmp_path, needs):
    needs("arm-none-eabi-gcc", "qemu-system-arm")
    (tmp_path / "m4.cmake").write_text(TOOLCHAIN)
    toolchain = f"-DCMAKE_TOOLCHAIN_FILE={tmp_path / 'm4.cmake'}"
    prefix = tmp_path / "installed"
    assert not list(install(folder, prefix, toolchain).rglob(f"{NAME}_test_vectors*"))
    project = user_project(tmp_path / "user", "C")
    (project / "startup.c").write_text(STARTUP)
    (project / "m4.ld").write_text(SCRIPT)
    link = f"--specs=rdimon.specs -nostartfiles -T {project / 'm4.ld'}"
    options = [toolchain, f"-DEXTRA_SOURCES={project / 'startup.c'}", f"-DCMAKE_EXE_LINKER_FLAGS={link}"]
    build = tmp_path / "build"
    run("cmake", "-S", project, "-B", build, *options, f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", build)
    assert run("qemu-system-arm", *MACHINE, "-kernel", build / "user_c").strip() == expected()
    # the package of the host is not taken for it
    said = run("cmake", "-S", project, "-B", tmp_path / "x", *options, f"-DCMAKE_PREFIX_PATH={installed}", fails=True)
    assert "(64bit)" in said


def test_a_cortex_m4_runs_the_vectors_by_ctest(folder, tmp_path, needs):
    needs("cmake", "ctest", "arm-none-eabi-gcc", "qemu-system-arm")
    (tmp_path / "startup.c").write_text(STARTUP)
    (tmp_path / "m4.ld").write_text(SCRIPT)
    run("arm-none-eabi-gcc", *CORTEX_M4, "-c", tmp_path / "startup.c", "-o", tmp_path / "startup.o")
    link = f"{tmp_path / 'startup.o'} --specs=rdimon.specs -nostartfiles -T {tmp_path / 'm4.ld'}"
    emulator = f'set(CMAKE_CROSSCOMPILING_EMULATOR "qemu-system-arm;{";".join(MACHINE)};-kernel")\n'
    (tmp_path / "m4.cmake").write_text(f'{TOOLCHAIN}{emulator}set(CMAKE_EXE_LINKER_FLAGS_INIT "{link}")\n')
    build = tmp_path / "build"
    run("cmake", "-S", folder, "-B", build, f"-DCMAKE_TOOLCHAIN_FILE={tmp_path / 'm4.cmake'}")
    run("cmake", "--build", build)
    said = run("ctest", "--test-dir", build, "--no-tests=error", "--verbose")
    assert re.search(r"[1-9]\d* vectors, 0 failed", said)
    source = folder / f"src/{NAME}.c"
    source.write_text(source.read_text().replace("delta[0] = ", "delta[0] = 1.1f * ", 1))
    run("cmake", "--build", build)
    assert f"{NAME}_vectors (Failed)" in run("ctest", "--test-dir", build, fails=True)


@pytest.mark.parametrize("name", ["test", "install"])
def test_a_name_that_cmake_keeps_to_itself(name, tmp_path, needs):
    needs("cmake", "ctest", "cc")
    block = Block(name)
    block.entry("step", inputs=[block.input("raw", range=(-1, 1))], outputs={}, following={})
    write_files(tmp_path / name, build_files(block, "float"))
    build = install(tmp_path / name, tmp_path / "installed")
    assert "100% tests passed" in run("ctest", "--test-dir", build, "--no-tests=error")
    user = tmp_path / "user"
    user.mkdir()
    (user / "user.c").write_text(f"#include <{name}.h>\nint main(void) {{ return {name}_model()[0] == 0; }}\n")
    take = f"find_package({name} REQUIRED)\nadd_executable(user user.c)\ntarget_link_libraries(user {name}::{name})\n"
    (user / "CMakeLists.txt").write_text(f"cmake_minimum_required(VERSION 3.13)\nproject(user C)\n{take}")
    run("cmake", "-S", user, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={tmp_path / 'installed'}")
    run("cmake", "--build", tmp_path / "build")
    run(tmp_path / "build/user")


# -- PlatformIO, Arduino, Zephyr --------------------------------------------------------------------------------------

SEMVER = re.compile(r"(0|[1-9]\d*)\.(0|[1-9]\d*)\.(0|[1-9]\d*)(\+[0-9A-Za-z-]+(\.[0-9A-Za-z-]+)*)?")
FLAGS = ["-ffp-contract=off", "-fno-math-errno"]


def complaints_of_platformio(folder):
    """What PlatformIO's schema and layout would not have (platformio/package/manifest/schema.py, and its docs)."""
    manifest = json.loads((folder / "library.json").read_text())
    wrong = [f"{field} is missing" for field in ("name", "version", "description") if not manifest.get(field)]
    if wrong:
        return wrong
    if not re.fullmatch(r"[^:;/,@<>]{1,100}", manifest["name"]):
        wrong.append("name")
    if not SEMVER.fullmatch(manifest["version"]) or len(manifest["version"]) > 20:
        wrong.append("version")
    if len(manifest["description"]) > 255:
        wrong.append("description")
    if any(not re.fullmatch(r"[a-z\d\-+. ]{1,50}", word) for word in manifest["keywords"]):
        wrong.append("keywords")
    if not all(re.fullmatch(r"[a-z\d\-_]+|\*", manifest[field]) for field in ("frameworks", "platforms")):
        wrong.append("frameworks")
    if "license" in manifest:
        wrong.append("license: the C belongs to its user, and only identifiers of SPDX's list are taken")
    if not (folder / manifest["build"]["srcDir"] / manifest["headers"]).is_file():
        wrong.append("headers")
    if manifest["build"]["flags"] != FLAGS:
        wrong.append("flags")
    for example in manifest["examples"]:
        if not re.fullmatch(r"[a-zA-Z\d\-_/]{1,100}", example["name"]):
            wrong.append("example name")
        wrong += [f"no {file}" for file in example["files"] if not (folder / example["base"] / file).is_file()]
    return wrong + complaints_of_layout(folder)


def complaints_of_layout(folder):
    """Only library code is in src: these tools compile all of it."""
    return [
        f"{path.name} in src" for path in (folder / "src").rglob("*") if path.name not in (f"{NAME}.c", f"{NAME}.h")
    ]


def complaints_of_arduino(folder):
    """What Arduino's library specification would not have."""
    lines = (folder / "library.properties").read_text().splitlines()
    fields = dict(line.split("=", 1) for line in lines if line)
    needed = "name version author maintainer sentence paragraph category url architectures includes".split()
    wrong = [f"{field} is missing" for field in needed if not fields.get(field)]
    if wrong or len(fields) != len(lines):
        return wrong or ["a field twice, or an empty line"]
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_.\- ]{0,62}", fields["name"]):
        wrong.append("name")
    if not SEMVER.fullmatch(fields["version"]) or "+" in fields["version"]:
        wrong.append("version")
    categories = (
        "Display|Communication|Signal Input/Output|Sensors|Device Control|Timing|Data Storage|Data Processing|Other"
    )
    if fields["category"] not in categories.split("|"):
        wrong.append("category")
    if not re.fullmatch(r"https?://\S+", fields["url"]):
        wrong.append("url")
    wrong += [f"no {file}" for file in fields["includes"].split(",") if not (folder / "src" / file).is_file()]
    for sketch in folder.rglob("*.ino"):
        if sketch.stem != sketch.parent.name or sketch.parent.parent != folder / "examples":
            wrong.append(f"{sketch.name} is not in examples, in a folder of its name")
    if not list(folder.rglob("*.ino")):
        wrong.append("no sketch")
    return wrong + complaints_of_layout(folder)


def complaints_of_zephyr(folder):
    """What Zephyr's build would not find: module.yml, the files it names, and symbols that both of them know."""
    import yaml

    module = yaml.safe_load((folder / "zephyr/module.yml").read_text())
    if not isinstance(module, dict) or not {"name", "build"} <= module.keys():
        return ["module.yml has no name or no build"]
    wrong = [] if re.fullmatch(r"[A-Za-z0-9_\-]+", module["name"]) else ["name"]
    cmake, kconfig = folder / module["build"].get("cmake", "?") / "CMakeLists.txt", folder / module["build"]["kconfig"]
    wrong += [f"no {path.name}" for path in (cmake, kconfig) if not path.is_file()]
    if wrong:
        return wrong
    known = re.findall(r"^config (\w+)$", kconfig.read_text(), re.MULTILINE)
    used = set(re.findall(r"CONFIG_(\w+)", cmake.read_text()))
    wrong += [f"{symbol} is not in Kconfig" for symbol in sorted(used - set(known))]
    for block in re.split(r"^config ", kconfig.read_text(), flags=re.MULTILINE)[1:]:
        if not re.search(r'^\tbool "[^"\\]+"$', block, re.MULTILINE) or "\thelp\n\t  " not in block:
            wrong.append(f"{block.split()[0]} has no type or no help")
    return wrong


COMPLAINTS = {"platformio": complaints_of_platformio, "arduino": complaints_of_arduino, "zephyr": complaints_of_zephyr}


@pytest.mark.parametrize("kind", COMPLAINTS)
def test_the_manifests_and_the_layout_are_what_the_format_asks_for(kind, written, needs):
    needs("python:yaml")
    assert COMPLAINTS[kind](written) == []


@pytest.mark.parametrize(
    ("kind", "file", "old", "new", "complaint"),
    [
        ("platformio", "library.json", '"version": "', '"version": "v', "version"),
        ("platformio", "library.json", '"name": "', '"name": "a/', "name"),
        ("platformio", "library.json", '"description"', '"descriptions"', "description is missing"),
        ("platformio", "library.json", '"plantc"', '"PLANTC_"', "keywords"),
        ("platformio", "library.json", "pendulum_ekf.h", "pendulum.h", "headers"),
        ("platformio", "library.json", "contract=off", "contract=fast", "flags"),
        ("platformio", "library.json", "example_main.c", "main.c", "no main.c"),
        ("platformio", "library.json", '"headers"', '"license": "LicenseRef-user", "headers"', "license"),
        ("arduino", "library.properties", "version=", "version=v", "version"),
        ("arduino", "library.properties", "\nauthor", "+ac32d234\nauthor", "version"),
        ("arduino", "library.properties", "category=Data", "category=data", "category"),
        ("arduino", "library.properties", "sentence=", "sentences=", "sentence is missing"),
        ("arduino", "library.properties", "url=https://", "url=", "url"),
        ("arduino", "library.properties", "includes=pendulum", "includes=pendulums", "no pendulums_ekf.h"),
        ("arduino", "library.properties", "name=", "name=_", "name"),
        ("zephyr", "zephyr/module.yml", "cmake: zephyr", "cmake: src", "no CMakeLists.txt"),
        ("zephyr", "zephyr/module.yml", "name:", "title:", "module.yml has no name"),
        ("zephyr", "zephyr/Kconfig", "config PLANTC_PENDULUM_EKF\n", "config PENDULUM_EKF\n", "is not in Kconfig"),
        ("zephyr", "zephyr/Kconfig", "\tbool ", "\tboolean ", "no type"),
    ],
)
def test_a_broken_field_is_seen(kind, file, old, new, complaint, folder, needs):
    needs("python:yaml")
    text = (folder / file).read_text()
    assert old in text
    (folder / file).write_text(text.replace(old, new, 1))
    assert any(complaint in said for said in COMPLAINTS[kind](folder))


def test_a_file_in_the_wrong_place_is_seen(folder):
    shutil.copy(folder / "examples/example_main.c", folder / "src/example_main.c")
    assert COMPLAINTS["platformio"](folder) == COMPLAINTS["arduino"](folder) == ["example_main.c in src"]
    (folder / "src/example_main.c").unlink()
    (folder / f"examples/{NAME}/{NAME}.ino").rename(folder / f"examples/{NAME}.ino")
    assert complaints_of_arduino(folder)
    assert complaints_of_platformio(folder)


ARDUINO = """
#include <cstdio>
struct Port {
    void begin(long) {}
    void println(const char *text) { std::puts(text); }
};
static Port Serial;
static void delay(unsigned long) {}
void setup();
void loop();
"""


def test_the_sketch_compiles_as_cpp_and_runs(written, tmp_path, needs):
    needs("c++", "cc")
    sketch = (written / f"examples/{NAME}/{NAME}.ino").read_text()
    mains = "int main() { setup(); for (int k = 0; k < 3; k++) loop(); return 0; }\n"
    (tmp_path / "sketch.cpp").write_text(f"{ARDUINO}{sketch}{mains}")
    source = written / f"src/{NAME}"
    run("cc", "-std=c99", "-c", f"{source}.c", "-o", tmp_path / "library.o")
    flags = ["-std=gnu++11", "-Wall", "-Wextra", "-Werror", f"-I{source.parent}"]
    run("c++", *flags, tmp_path / "sketch.cpp", tmp_path / "library.o", "-lm", "-o", tmp_path / "sketch")
    assert run(tmp_path / "sketch") == "ok\n"


ZEPHYR = """
cmake_minimum_required(VERSION 3.20)
project(zephyr_stub LANGUAGES C)
add_library(zephyr_interface INTERFACE)
function(zephyr_include_directories)
    target_include_directories(zephyr_interface INTERFACE ${ARGV})
endfunction()
macro(zephyr_library_named name)
    set(ZEPHYR_CURRENT_LIBRARY ${name})
    add_library(${name} STATIC "")
    target_link_libraries(${name} PUBLIC zephyr_interface)
    set_property(GLOBAL APPEND PROPERTY ZEPHYR_LIBS ${name})
endmacro()
function(zephyr_library_sources)
    target_sources(${ZEPHYR_CURRENT_LIBRARY} PRIVATE ${ARGN})
endfunction()
function(zephyr_library_compile_options)
    target_compile_options(${ZEPHYR_CURRENT_LIBRARY} PRIVATE ${ARGN})
endfunction()
add_subdirectory(${MODULE}/zephyr module)
get_property(libraries GLOBAL PROPERTY ZEPHYR_LIBS)
message(STATUS "libraries: [${libraries}]")
add_executable(user user.c)
target_link_libraries(user PRIVATE ${libraries} zephyr_interface m)
"""


def test_the_zephyr_module_builds_with_stubs_of_zephyrs_functions(written, tmp_path, needs):
    needs("cmake", "cc")
    project = user_project(tmp_path / "user", "C")
    (project / "CMakeLists.txt").write_text(ZEPHYR)
    off = run("cmake", "-S", project, "-B", tmp_path / "off", f"-DMODULE={written}")
    assert "libraries: []" in off
    build = tmp_path / "on"
    options = ["-DCONFIG_PLANTC_PENDULUM_EKF=y", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", f"-DMODULE={written}"]
    assert f"libraries: [{NAME}]" in run("cmake", "-S", project, "-B", build, *options)
    run("cmake", "--build", build)
    assert run(build / "user").strip() == expected()
    commands = build / "compile_commands.json"
    assert " ".join(FLAGS) in commands.read_text()
    run("cmake", "-S", project, "-B", build, *options, "-DCONFIG_PLANTC_PENDULUM_EKF_CONTRACT=y")
    assert "-ffp-contract=fast" in commands.read_text()


# -- versions and descriptions ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("version", "release"),
    [("0.1.0", "0.1.0"), ("1.2", "1.2.0"), ("3", "3.0.0"), ("0+unknown", "0.0.0"), ("1.2.3.dev4+g5", "1.2.3"),
     ("01.2rc1", "1.2.0"), ("unknown", "0.0.0"), ("2.3.4.5", "2.3.4")],
)  # fmt: skip
def test_the_release_is_three_numbers(version, release):
    assert release_of(version) == release
    assert SEMVER.fullmatch(release)


@pytest.mark.parametrize(
    "doc",
    [
        'says "yes"; costs $HOME ${x} @VERSION@ # no comment',
        "first line\n  second = line \\ with a backslash",
        "*/ int main(void) /* " * 3,
        "grüßt die Welt",
        "word " * 100,
        "$",
        "",
    ],
)
def test_any_docstring_gives_valid_manifests(doc, tmp_path, needs):
    needs("cmake", "cc", "pkg-config", "python:yaml")
    block = Block(NAME, doc=doc)
    block.entry("step", inputs=[block.input("raw", range=(-1, 1))], outputs={}, following={})
    assert 0 < len(sentence_of(block)) <= LONGEST_SENTENCE
    write_files(tmp_path / NAME, build_files(block, "float"))
    for complaints in COMPLAINTS.values():
        assert complaints(tmp_path / NAME) == []
    run("cmake", "-S", tmp_path / NAME, "-B", tmp_path / "build")
    said = run("pkg-config", "--exists", "--print-errors", tmp_path / f"build/{NAME}.pc")
    assert said == ""
    text = (tmp_path / f"build/{NAME}.pc").read_text()
    assert f"Description: {sentence_of(block)}\n" in text


def test_the_files_are_the_same_bytes_each_time(written):
    again = build_files(pendulum_ekf, "float")
    assert files_in(written) == sorted(again)
    assert all((written / file).read_text(encoding="utf-8") == text for file, text in again.items())
    assert all(text.endswith("\n") and not text.endswith("\n\n") for text in again.values())
    assert not any(str(written.parent) in text or os.environ.get("HOME", "/root") in text for text in again.values())


# -- blocks that lack something ---------------------------------------------------------------------------------------

LACKING = {
    "gain": "memory",
    "plain_gain": "memory parameter",
    "source": "memory input",
    "sink": "output",
    "ticker": "parameter input output",
    "nothing": "memory parameter input output",
}


def bare(name):
    """A block without what `LACKING` says."""
    without = LACKING[name].split()
    block = Block(name, doc="a block that lacks something")
    raw = block.input("raw", unit="V", range=(-10, 10)) if "input" not in without else None
    weight = block.parameter("weight", 0.1, range=(0, 1)) if "parameter" not in without else 0.5
    smooth = block.memory("smooth", initial=0.0, unit="V", range=(-10, 10)) if "memory" not in without else 0.0
    value = weight * (1.0 if raw is None else raw) + 0.5 * smooth
    following = {smooth: value} if "memory" not in without else {}
    outputs = {"level": value} if "output" not in without else {}
    block.entry("step", inputs=[] if raw is None else [raw], following=following, outputs=outputs)
    return block


@pytest.mark.slow
@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("name", LACKING)
def test_a_block_that_lacks_something_is_exported_and_its_vectors_can_fail(name, precision, tmp_path):
    done = export(bare(name), tmp_path, precision=precision, steps=20)
    assert done.passed
    files = dict(done.files)
    result = package.run_vectors(name, files)
    assert result.passed
    assert result.calls > 0
    files[f"src/{name}.c"] = files[f"src/{name}.c"].replace(done.block.model_hash() + '"', '00000000"')
    assert not package.run_vectors(name, files).passed
    if "output" not in LACKING[name]:
        half = "0.5f" if precision == "float" else "0.5"
        broken = dict(done.files)
        source = broken[f"src/{name}.c"]
        changed = re.sub(r"level = (.*);", rf"level = {half} + (\1);", source)
        assert changed != source
        broken[f"src/{name}.c"] = changed
        assert "differ" in package.run_vectors(name, broken).note


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("precision", ["double", "float"])
def test_every_c_file_and_the_sketch_of_such_a_block_compile_without_a_warning(compiler, precision, tmp_path, needs):
    needs(compiler)
    for name in LACKING:
        folder = tmp_path / name
        write_files(folder, build_files(bare(name), precision))
        files = [str(path) for path in sorted(folder.rglob("*.c"))]
        assert len(files) == 4
        command = [compiler, "-std=c99", "-O2", *WARNINGS, f"-I{folder / 'src'}", "-fsyntax-only", *files]
        run(*command)
        sketch = (folder / f"examples/{name}/{name}.ino").read_text()
        (folder / "sketch.cpp").write_text(ARDUINO + sketch)
        run(
            compiler,
            "-std=gnu++11",
            "-Wall",
            "-Wextra",
            "-Werror",
            "-fsyntax-only",
            f"-I{folder}/src",
            folder / "sketch.cpp",
        )
