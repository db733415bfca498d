"""Size and speed of the quadrotor's extended Kalman filter, beside CasADi's own generator on the textbook formulas.

Instructions are counted by callgrind, so the figures do not depend on what else the machine does.
"""

from __future__ import annotations

import argparse
import json
import re
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import casadi as ca
from plantc.examples.quadrotor_ekf import quadrotor_ekf, sampled
from plantc.symbolic.discretisation import transition

from plantc import emit, export

STEPS = 50
NAME = "quadrotor_ekf"
DRIVER = """
#include "quadrotor_ekf.h"
#include <math.h>
int main(void)
{
    static quadrotor_ekf_state_t state;
    static const quadrotor_ekf_params_t params = QUADROTOR_EKF_PARAMS_DEFAULT;
    static quadrotor_ekf_step_in_t in;
    static quadrotor_ekf_step_out_t out;
    quadrotor_ekf_predict_in_t predict_in = {212.7, 212.7, 212.7, 212.7};
    quadrotor_ekf_update_pose_in_t pose_in;
    quadrotor_ekf_update_pose_out_t pose_out;
    quadrotor_ekf_inflate_in_t inflate_in = {1.01};
    int good = (quadrotor_ekf_init(&state, &params) == 0);
    in.rotor_1 = 212.7; in.rotor_2 = 212.7; in.rotor_3 = 212.7; in.rotor_4 = 212.7;
    in.has_pose = true;
    for (int k = 1; k <= STEPS; k++)
    {
        for (int i = 0; i < 12; i++)
        {
            in.pose[i] = ((i == 4) ? 30.0 : 0.0) + (0.05 * sin((1.7 * k * i) + (0.7 * i * i) + 0.2));
            pose_in.pose[i] = in.pose[i];
        }
        good = good && (quadrotor_ekf_step(&state, &params, &in, &out) == 0);
        good = good && (quadrotor_ekf_predict(&state, &params, &predict_in) == 0);
        good = good && (quadrotor_ekf_update_pose(&state, &params, &pose_in, &pose_out) == 0);
        good = good && (quadrotor_ekf_inflate(&state, &params, &inflate_in) == 0);
    }
    return good ? 0 : 1;
}
"""
SIZE_DRIVER = """
#include "quadrotor_ekf.h"
quadrotor_ekf_state_t state;
quadrotor_ekf_params_t params;
quadrotor_ekf_step_in_t in;
quadrotor_ekf_step_out_t out;
int main(void) { return (int)quadrotor_ekf_step(&state, &params, &in, &out); }
"""
PEER_DRIVER = """
#include <math.h>
extern int textbook(const double **arg, double **res, long long int *iw, double *w, int mem);
int main(void)
{
    static double x[12], p[144], u[4] = {212.7, 212.7, 212.7, 212.7}, z[12], nx[12], np[144];
    static long long int iw[IW + 1];
    static double w[W + 1];
    const double *arg[4] = {x, p, u, z};
    double *res[2] = {nx, np};
    x[4] = 30.0;
    for (int i = 0; i < 12; i++) { p[13 * i] = 0.01 / 3.0; }
    for (int k = 1; k <= STEPS; k++)
    {
        for (int i = 0; i < 12; i++)
        {
            z[i] = ((i == 4) ? 30.0 : 0.0) + (0.05 * sin((1.7 * k * i) + (0.7 * i * i) + 0.2));
        }
        if (textbook(arg, res, iw, w, 0) != 0) { return 1; }
        for (int i = 0; i < 12; i++) { x[i] = nx[i]; }
        for (int i = 0; i < 144; i++) { p[i] = np[i]; }
    }
    return (fabs(x[4] - 30.0) < 1.0) ? 0 : 1;
}
"""


def run(*command: str, folder: Path) -> str:
    """Run a program and return what it printed."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)} ended with {done.returncode}: {done.stderr[-2000:]}")
    return done.stdout + done.stderr


def instructions(folder: Path, program: str, function: str) -> float:
    """Return instructions per call of a function, callees included."""
    printed = run(
        "valgrind", "--tool=callgrind", "--callgrind-out-file=callgrind.out", f"--toggle-collect={function}", f"./{program}",
        folder=folder,
    )  # fmt: skip
    counted = re.search(r"Collected : (\d+)", printed)
    assert counted is not None
    return int(counted.group(1)) / STEPS


def textbook_c(folder: Path) -> dict[str, int]:
    """Write the textbook filter by CasADi's generator and return the sizes of its work vectors."""
    x, u = sampled.x, sampled.u
    following, F = transition(sampled)
    P, z = ca.SX.sym("P", 12, 12), ca.SX.sym("z", 12)
    Q, R = 1e-6 * ca.SX.eye(12), 0.01 * ca.SX.eye(12)
    prior = ca.densify(F) @ P @ ca.densify(F).T + Q
    S = prior + R
    K = ca.solve(S, prior).T
    corrected = following + K @ (z - following)
    step = ca.Function("textbook", [x, P, u, z], [corrected, (ca.SX.eye(12) - K) @ prior])
    generator = ca.CodeGenerator("textbook.c")
    generator.add(step)
    generator.generate(str(folder) + "/")
    return {"IW": step.sz_iw(), "W": step.sz_w()}


def measure() -> dict[str, object]:
    """Return every figure."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        figures: dict[str, object] = {}
        started = time.perf_counter()
        export(quadrotor_ekf, folder / "out")
        figures["export_seconds"] = round(time.perf_counter() - started, 1)
        figures.update(_host(folder))
        figures.update(_cortex(folder))
        figures["casadi_instructions_per_step"] = _peer(folder)
        ours, peer = figures["instructions_step"], figures["casadi_instructions_per_step"]
        assert isinstance(ours, float) and isinstance(peer, float)
        figures["ratio_to_casadi"] = round(peer / ours, 2)
        return figures


def _write(folder: Path, precision: str) -> dict[str, dict[str, int]]:
    text = emit(quadrotor_ekf, precision)
    (folder / f"{NAME}.h").write_text(text.header)
    (folder / f"{NAME}.c").write_text(text.source)
    return text.operations


def _host(folder: Path) -> dict[str, object]:
    """Instructions, text and divisions in double, gcc -O2."""
    operations = _write(folder, "double")
    (folder / "driver.c").write_text(DRIVER)
    (folder / "size.c").write_text(SIZE_DRIVER)
    flags = ["-std=c99", "-O2", "-ffp-contract=off"]
    run("gcc", *flags, "-g", f"-DSTEPS={STEPS}", "driver.c", f"{NAME}.c", "-o", "driver", "-lm", folder=folder)
    answer: dict[str, object] = {
        f"instructions_{entry}": instructions(folder, "driver", f"{NAME}_{entry}")
        for entry in ("predict", "update_pose", "inflate")
    }
    # predict and update_pose have entries of their own, so step is counted by its own name
    answer["instructions_step"] = instructions(folder, "driver", f"{NAME}_step")
    run(
        "gcc",
        *flags,
        "-ffunction-sections",
        "-Wl,--gc-sections",
        "size.c",
        f"{NAME}.c",
        "-o",
        "size",
        "-lm",
        folder=folder,
    )
    symbols = run("nm", "-S", "size", folder=folder)
    sizes = {
        line.split()[-1]: int(line.split()[1], 16)
        for line in symbols.split("\n")
        if NAME in line and " t " in line.lower()
    }
    answer["text_step_bytes"] = sum(sizes.values())
    answer["divisions"] = operations["predict"].get("division", 0) + operations["update_pose"]["division"]
    return answer


def _cortex(folder: Path) -> dict[str, object]:
    """Static count of instructions of `step` and what it calls, in float on a Cortex-M4F, contraction on."""
    _write(folder, "float")
    target = ["-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard"]
    flags = ["-std=gnu99", "-O2", "-ffp-contract=fast", "-fno-schedule-insns", "-c", f"{NAME}.c", "-o", "m4.o"]
    run("arm-none-eabi-gcc", *target, *flags, folder=folder)
    listing = run("arm-none-eabi-objdump", "-d", "--no-show-raw-insn", "m4.o", folder=folder)
    counts: dict[str, int] = {}
    current = ""
    for line in listing.split("\n"):
        head = re.match(r"^[0-9a-f]+ <(\w+)>:", line)
        if head:
            current = head.group(1)
            counts[current] = 0
        elif re.match(r"^ +[0-9a-f]+:\t", line) and ".word" not in line:
            counts[current] += 1
    others = {
        f"{NAME}_{name}" for name in ("init", "init_core", "predict", "update_pose", "inflate", "model", "status_text")
    }
    undefined = run("arm-none-eabi-nm", "-u", "m4.o", folder=folder).split()
    size = run("arm-none-eabi-size", "m4.o", folder=folder).split("\n")[1].split()
    return {
        "cortex_m4f_static_step": sum(count for name, count in counts.items() if name not in others),
        "cortex_m4f_object_text_bytes": int(size[0]),
        "float_undefined_symbols": sorted(name for name in undefined if name != "U"),
    }


def _peer(folder: Path) -> float:
    """Return instructions per step of CasADi's own C."""
    sizes = textbook_c(folder)
    (folder / "peer.c").write_text(PEER_DRIVER)
    defines = [f"-D{key}={value}" for key, value in sizes.items()]
    run("gcc", "-O2", "-g", f"-DSTEPS={STEPS}", *defines, "peer.c", "textbook.c", "-o", "peer", "-lm", folder=folder)
    return instructions(folder, "peer", "textbook")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    arguments = parser.parse_args()
    for tool in ("gcc", "valgrind", "arm-none-eabi-gcc"):
        if shutil.which(tool) is None:
            raise SystemExit(f"{tool} is missing; install gcc, valgrind and gcc-arm-none-eabi")
    figures = measure()
    if arguments.json:
        print(json.dumps(figures, indent=2))
        return
    for key, value in figures.items():
        print(f"{key:34} {value}")


if __name__ == "__main__":
    main()
