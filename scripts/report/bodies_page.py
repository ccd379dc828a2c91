"""The page of an experiment on bodies."""

from . import bodies as drawing
from .page import Page, chip, integer, number, prose

# Of what a scene is for; what is not here is a ratio.
UNITS = {"heat_taken": "N", "work_given": "N", "first_step_temperature_change": "K", "lowest_temperature": "K",
         "highest_temperature": "K", "adiabatic_temperature_rise": "K", "effective_modulus": "MPa", "perfect_modulus": "MPa",
         "closed_form_modulus": "MPa", "interface_stiffness": "MPa/mm", "acceleration": "m/s²",
         "closed_form_acceleration": "m/s²", "force": "N/mm", "half_width": "mm", "closed_form_half_width": "mm",
         "peak_pressure": "MPa", "closed_form_peak_pressure": "MPa", "frequency": "Hz", "closed_form_frequency": "Hz"}


def _with_unit(name, value):
    return " ".join([f"{value:.5g}".replace("-", "−"), UNITS.get(name, "")]).rstrip()


def page_of_bodies(bodies):
    headline = "The experiment ran through and passed its tests." if bodies.accepted else \
        "The experiment was not accepted; its numbers below are no result."
    page = Page(kicker="Kerf · an experiment on bodies", title=bodies.title, headline=[headline],
                code_version=bodies.code_version)
    section = page.section("What it says")
    section.warnings([prose(reason) for reason in bodies.refusals])
    section.facts([("verdict", chip("accepted") if bodies.accepted else chip("not accepted", "no"), "")] +
                  [(name.replace("_", " "), _with_unit(name, value), "") for name, value in bodies.results.items()])
    velocity, vibration = drawing.velocity_picture(bodies), drawing.vibration_picture(bodies)
    if velocity:
        page.section("Speed").figure(velocity, "Of the centre of mass of the bodies that deform.")
    elif vibration:
        page.section("Vibration").figure(vibration, "The last four periods; twice in each all of the "
                                               "energy is kinetic.")
    else:
        page.section("Force on the way").figure(drawing.force_picture(bodies), "Force of the piston on the bodies per "
                                                "width, pulling positive, means between readings.")
    pressure = drawing.pressure_picture(bodies)
    if pressure:
        page.section("Pressure and volume").figure(pressure, "Isothermal strokes keep p V, adiabatic ones p V^γ, "
                                                   "from where they begin.")
    temperature = drawing.temperature_picture(bodies)
    if temperature:
        page.section("Temperature on the way").figure(temperature, "Means over the bodies.")
    pressed = drawing.pressed_picture(bodies)
    if pressed:
        page.section("Where bodies touch").figure(pressed, "Normal forces of the nodes, summed across the box, means over "
                                                           "the second half of the last stroke.")
    heat = drawing.heat_picture(bodies)
    if heat:
        page.section("Temperature and entropy").figure(heat, "Means over the bodies. Heat at constant temperature runs "
                                                       "level, deformation without heat runs upright.")
    page.section("Where the energy went").figure(drawing.energy_picture(bodies), "Work and heat that came in, and what "
                                                 "became of them; damping is part of the ledger too.")
    page.section("Cost").facts([("wall time", f"{number(bodies.cost['wall_s'])} s", ""),
                                ("time steps", integer(bodies.cost["steps"]), ""),
                                ("particles", integer(bodies.cost["particles"]), "")])
    page.section("Scene").source("the scene as it was read", bodies.scene)
    return page
