"""Billiard balls on cloth, for tests of their impacts and of their motion."""

from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import ContactModel
from sandbox.engine.model.surface import Bounce
from sandbox.physics.cloth import Cloth

R = 0.028575  # m
M = 0.170097  # kg
CLOTH = Cloth()
RIGID = ContactModel("rigid")


def ball(name, position, velocity=(0.0, 0.0), spin=0.0, rolling_spin=(0.0, 0.0)):
    return Ball(name, M, R, position, velocity, spin, rolling_spin)


def rolling(name, position, velocity):
    return ball(name, position, velocity, 0.0, (-velocity[1] / R, velocity[0] / R))


def of(restitution, friction):
    return lambda normal, slip: Bounce(restitution, friction)
