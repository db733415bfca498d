"""Where something was said: lines of the user's file, by base name."""

from plantc.symbolic import Plant
from plantc.symbolic.analysis import linearised_plant
from plantc.symbolic.origins import place_of_call, said_at

MODEL = """from plantc.symbolic import Plant

plant = Plant("cart", dt=0.1)
speed = plant.state("speed", unit="m/s")
position = plant.state("position", unit="m")
push = plant.input("push", unit="m/s^2")
rates = {speed: speed + 0.1 * push, position: position + 0.1 * speed}
if literal:
    plant.dynamics({
        position: position + 0.1 * speed,

        speed: speed + 0.1 * push,
    })
else:
    plant.dynamics(rates)
plant.sensor("gauge", position, unit="m", variance=1e-2)
"""


def made(tmp_path, literal):
    path = tmp_path / "cart.py"
    path.write_text(MODEL)
    names = {"__name__": "cart", "literal": literal}
    exec(compile(MODEL, str(path), "exec"), names)
    return names["plant"]


def test_each_item_of_a_dictionary_has_its_own_line(tmp_path):
    plant = made(tmp_path, True)
    assert plant.dynamics_sources == {"position": "cart.py:10", "speed": "cart.py:12"}
    assert [state.signal.source for state in plant.states] == ["cart.py:4", "cart.py:5"]
    assert plant.sensors[0].signal.source == "cart.py:16"


def test_a_dictionary_made_elsewhere_has_the_line_of_the_call(tmp_path):
    assert set(made(tmp_path, False).dynamics_sources.values()) == {"cart.py:15"}


def test_a_linearised_plant_belongs_to_the_lines_of_the_original(tmp_path):
    plant = made(tmp_path, True)
    linear = linearised_plant(plant)
    assert linear.dynamics_sources == plant.dynamics_sources
    assert [s.signal.source for s in linear.states] == [s.signal.source for s in plant.states]
    assert linear.sensors[0].signal.source == plant.sensors[0].signal.source


def test_lines_are_no_part_of_a_signal_or_of_the_model():
    signals = []
    for source in ("a.py:1", "b.py:2"):
        with said_at(source):
            assert place_of_call() == source
            signals.append(Plant("p").state("x").signal)
    assert signals[0] == signals[1]
    assert repr(signals[0]) == repr(signals[1])
    assert signals[0].source != signals[1].source


def test_what_no_file_says_has_no_line():
    names = {"__name__": "console", "place_of_call": place_of_call}
    assert eval(compile("place_of_call()", "<stdin>", "eval"), names) == ""
