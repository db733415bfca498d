"""Instructions of a step by form of the covariance: the quadrotor with six sensors, beside the default form.

Instructions are counted by callgrind, so the figures do not depend on what else the machine does.
"""

from __future__ import annotations

import argparse
import json
import shutil
import tempfile
from pathlib import Path

from plantc.examples.quadrotor_ud import hover, rotors, sampled6, states
from plantc.symbolic.estimators import extended_kalman_filter
from plantc.symbolic.forms import FORMS
from quadrotor import STEPS, instructions, run

from plantc import emit

NAME = "quadrotor_form"
ENTRIES = ("step", "predict", "update_pose")
DRIVER = """
#include "quadrotor_form.h"
#include <math.h>
int main(void)
{
    static quadrotor_form_state_t state;
    static const quadrotor_form_params_t params = QUADROTOR_FORM_PARAMS_DEFAULT;
    static quadrotor_form_step_in_t in;
    static quadrotor_form_step_out_t out;
    quadrotor_form_predict_in_t predict_in = {212.7, 212.7, 212.7, 212.7};
    quadrotor_form_update_pose_in_t pose_in;
    quadrotor_form_update_pose_out_t pose_out;
    int good = (quadrotor_form_init(&state, &params) == 0);
    in.rotor_1 = 212.7; in.rotor_2 = 212.7; in.rotor_3 = 212.7; in.rotor_4 = 212.7;
    in.has_pose = true;
    for (int k = 1; k <= STEPS; k++)
    {
        for (int i = 0; i < 6; i++)
        {
            in.pose[i] = ((i == 2) ? 30.0 : 0.0) + (0.05 * sin((1.7 * k * i) + (0.7 * i * i) + 0.2));
            pose_in.pose[i] = in.pose[i];
        }
        good = good && (quadrotor_form_step(&state, &params, &in, &out) == 0);
        good = good && (quadrotor_form_predict(&state, &params, &predict_in) == 0);
        good = good && (quadrotor_form_update_pose(&state, &params, &pose_in, &pose_out) == 0);
    }
    return good ? 0 : 1;
}
"""
"""Runs every entry as often; a call that is not good makes it fail."""


def measure(precision: str) -> dict[str, dict[str, float]]:
    """Return form -> entry -> instructions per call, and the bytes of text of the whole library (gcc -O2)."""
    answer: dict[str, dict[str, float]] = {}
    for form in FORMS:
        block = extended_kalman_filter(
            sampled6,
            initial_variance=dict.fromkeys(states, 0.01 / 3),
            around={states[4]: 30.0, **dict.fromkeys(rotors, hover)},
            form=form,
            name=NAME,
        )
        text = emit(block, precision)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / f"{NAME}.h").write_text(text.header)
            (folder / f"{NAME}.c").write_text(text.source)
            (folder / "driver.c").write_text(DRIVER)
            flags = ["-std=c99", "-O2", "-ffp-contract=off", "-g", f"-DSTEPS={STEPS}"]
            run("gcc", *flags, "driver.c", f"{NAME}.c", "-o", "driver", "-lm", folder=folder)
            own: dict[str, float] = {entry: instructions(folder, "driver", f"{NAME}_{entry}") for entry in ENTRIES}
            run("gcc", *flags, "-c", f"{NAME}.c", "-o", "library.o", folder=folder)
            own["text"] = int(run("size", "library.o", folder=folder).split("\n")[1].split()[0])
        answer[form] = own
    return answer


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--precision", choices=("double", "float"), default="double")
    arguments = parser.parse_args()
    for tool in ("gcc", "valgrind"):
        if shutil.which(tool) is None:
            raise SystemExit(f"{tool} is missing; install gcc and valgrind")
    figures = measure(arguments.precision)
    if arguments.json:
        print(json.dumps(figures, indent=2))
        return
    for form, own in figures.items():
        ratio = own["step"] / figures["conventional"]["step"]
        print(f"{form:14}" + "".join(f"{key} {value:8.0f}   " for key, value in own.items()) + f"x {ratio:.2f}")


if __name__ == "__main__":
    main()
