"""The page of an experiment on bodies."""

from . import bodies as drawing
from .page import Page, chip, integer, number, prose


def page_of_bodies(bodies):
    headline = "The experiment ran through and passed its tests." if bodies.accepted else \
        "The experiment was not accepted; its numbers below are no result."
    page = Page(kicker="Kerf · an experiment on bodies", title=bodies.title, headline=[headline],
                code_version=bodies.code_version)
    section = page.section("What it says")
    section.warnings([prose(reason) for reason in bodies.refusals])
    section.facts([("verdict", chip("accepted") if bodies.accepted else chip("not accepted", "no"), "")] +
                  [(name.replace("_", " "), f"{value:.5g}".replace("-", "−"), "") for name, value in bodies.results.items()])
    velocity = drawing.velocity_picture(bodies)
    if velocity:
        page.section("Speed").figure(velocity, "Of the centre of mass of the bodies that deform.")
    else:
        page.section("Force on the way").figure(drawing.force_picture(bodies), "Force of the piston on the bodies per "
                                                "width, pulling positive, means between readings.")
    pressed = drawing.pressed_picture(bodies)
    if pressed:
        page.section("Where bodies touch").figure(pressed, "Normal forces of the nodes, summed across the box, means over "
                                                           "the second half of the last stroke.")
    heat = drawing.heat_picture(bodies)
    if heat:
        page.section("Temperature and entropy").figure(heat, "Means over the bodies. Heat at constant temperature runs "
                                                       "level, deformation without heat runs upright.")
    page.section("Where the energy went").figure(drawing.energy_picture(bodies), "Work and heat that came in, and what "
                                                 "became of them; kinetic energy and damping are part of the ledger.")
    page.section("Cost").facts([("wall time", f"{number(bodies.cost['wall_s'])} s", ""),
                                ("time steps", integer(bodies.cost["steps"]), ""),
                                ("particles", integer(bodies.cost["particles"]), "")])
    page.section("Scene").source("the scene as it was read", bodies.scene)
    return page
