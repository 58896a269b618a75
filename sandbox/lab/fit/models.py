"""Several models compared by how well they explain the data: a fit with each, ranked by Akaike's criterion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import inf
from typing import Any

from sandbox.errors import RequestError, RunError
from sandbox.lab.axes import checked
from sandbox.lab.fit.problem import Problem
from sandbox.lab.fit.remedy import explained
from sandbox.lab.fit.squares import FarOff, Fit, Model, check_near, solve
from sandbox.parameters import choices_of, value_at
from sandbox.scene import Scene
from sandbox.text import nearest
from sandbox.toml import toml_value

#: Fewer models cannot be compared.
FEWEST = 2


def parse_models(scene: Scene, option: str, text: str) -> tuple[str, tuple[Any, ...]]:
    """``KEY=A,B,C``, or ``KEY`` for all that it can be. Raises RequestError."""
    key, equals, body = (part.strip() for part in text.partition("="))
    words = [toml_value(part.strip()) for part in body.split(",")] if equals else []
    return key, chosen_models(scene, option, key, words)


def chosen_models(scene: Scene, option: str, key: str, words: Sequence[Any] = ()) -> tuple[Any, ...]:
    """The models to compare, by default all that the parameter ``key`` can name. Raises RequestError."""
    known = choices_of(scene.parameters, key)
    if not known:
        if isinstance(value_at(scene.parameters, key), int | float):
            raise RequestError(f"{option} {key}: is a number, not a choice of models; --vary fits it")
        checked(scene, option, key, "")  # says what is wrong with the key
    for word in words:
        if word not in known:
            near = nearest(str(word), [str(each) for each in known])
            hint = f"did you mean {near}?" if near else f"choose from {', '.join(map(str, known))}"
            raise RequestError(f"{option} {key}: no {word!r}; {hint}")
    found = tuple(dict.fromkeys(words)) or known
    if len(found) < FEWEST:
        raise RequestError(f"{option} {key}: {found[0]} alone cannot be compared; name at least two")
    return found


def _has(scene: Scene, key: str, value: float) -> bool:
    """True if the scene, with the model that it has, can be given a parameter."""
    try:
        return checked(scene, "--vary", key, value) is not None
    except RequestError:
        return False


def compare(problem: Problem, key: str, words: Sequence[Any]) -> Fit:
    """The fit of the best model, with all that were compared. Raises RequestError or RunError if none can be fitted.

    Each is fitted with those of the ranges whose parameter it has.
    """
    found: dict[str, Model] = {}
    failure: RequestError | RunError | None = None
    for word in words:
        try:
            changed = problem.scene.changed({key: word}, "--models")
            own = [span for span in problem.spans if _has(changed, span.key, span.low)]
            if not own:
                raise RequestError(f"{word} has none of the parameters to fit")
            own_problem = Problem(changed, problem.measured, own, problem.robust, problem.progress)
            found[str(word)] = Model(0.0, solve(own_problem, near=False))
        except (RequestError, RunError) as error:
            failure = failure or error
            found[str(word)] = Model(inf, None, str(error))
    least = min((each.fit.aicc for each in found.values() if each.fit is not None), default=inf)
    if least == inf:
        assert failure is not None
        raise failure
    models = {
        word: each if each.fit is None else replace(each, behind=each.fit.aicc - least) for word, each in found.items()
    }
    ordered = dict(sorted(models.items(), key=lambda item: item[1].behind))
    best = next(iter(ordered.values())).fit
    assert best is not None
    try:
        check_near(best.scene, problem.measured, best.residuals, problem.robust)
    except FarOff as error:
        raise explained(error, problem) from None
    return replace(best, models=ordered, models_of=key)
