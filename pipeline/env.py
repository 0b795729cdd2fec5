"""The environments by name; see docs/environment.md.

    import gymnasium
    import holdfast

    env = gymnasium.make("Holdfast/GraspChoice-v0")
    observation, info = env.reset(seed=0)
    observation, reward, terminated, truncated, info = env.step(0)

`Holdfast/GraspChoice-v0` and `Holdfast/GraspChoiceSequential-v0` choose among candidates of many objects,
whose mass, friction, centre of mass and placement are hidden: `pipeline/environment`.

With `task=` the first one is `GraspChoiceEnv`: one task under conditions that are seen.
"""

from collections.abc import Callable, Iterable
from inspect import Parameter, signature
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..arguments import check_whole_number
from ..errors import InputError, UnknownName
from ..gymnasium_ids import GRASP_CHOICE
from . import environment
from .environment import ChoiceEnv, Reward

if TYPE_CHECKING:
    from ..objects import Task
    from .environment import FRICTIONS, WEIGHTS, GraspChoiceEnv, Physics, Table, TableVectorEnv

__all__ = [
    "ENV_ID",
    "FRICTIONS",
    "WEIGHTS",
    "GraspChoiceEnv",
    "make_grasp_choice",
    "make_grasp_choice_sequential",
    "make_grasp_choice_sequential_vector",
    "make_grasp_choice_vector",
]

ENV_ID = GRASP_CHOICE


# What is named here is imported when it is used: a table needs neither solver nor simulator.
_BACKENDS = {"table": "Table", "physics": "Physics"}
_USUAL_TRIES = 4


def make_grasp_choice(
    task: "str | Path | Task | None" = None,
    *,
    backend: str = "table",
    candidates: int = 8,
    reward: str = "held",
    cost: float = 0.0,
    render_mode: str | None = None,
    **options: Any,
) -> "ChoiceEnv | GraspChoiceEnv":
    """`Holdfast/GraspChoice-v0`: one choice among K candidates.

    Args:
        task: one task under conditions that are seen; then further options are those of `GraspChoiceEnv`.
        backend: `table` for outcomes that are known, `physics` for tests in MuJoCo.
        candidates: K.
        reward: `held`, or `margin`.
        cost: of a try, taken off the reward.
        render_mode: None, `rgb_array` or `human`.
        options: of the back end, see `Table` and `Physics`.

    Raises:
        InputError: an option that can't be used.
    """
    if task is not None:
        _check_of_one_task(backend, reward, cost, options)
        return environment.GraspChoiceEnv(task, candidates=candidates, render_mode=render_mode, **options)
    return ChoiceEnv(
        _backend(backend, options, make_grasp_choice),
        candidates=candidates,
        reward=_reward(reward, cost),
        render_mode=render_mode,
    )


def make_grasp_choice_sequential(
    *,
    tries: int = _USUAL_TRIES,
    backend: str = "table",
    candidates: int = 8,
    reward: str = "held",
    cost: float = 0.0,
    render_mode: str | None = None,
    **options: Any,
) -> ChoiceEnv:
    """`Holdfast/GraspChoiceSequential-v0`: up to `tries` tries, whose outcomes are seen, until one is held.

    Args:
        tries: how many, at least two.
        backend: see `make_grasp_choice`, as are the others.
        candidates: K.
        reward: of each try.
        cost: of each try.
        render_mode: None, `rgb_array` or `human`.
        options: of the back end.

    Raises:
        InputError: an option that can't be used.
    """
    check_whole_number("tries", tries, least=2)
    return ChoiceEnv(
        _backend(backend, options, make_grasp_choice_sequential),
        candidates=candidates,
        tries=tries,
        reward=_reward(reward, cost),
        render_mode=render_mode,
    )


def make_grasp_choice_vector(
    num_envs: int = 1,
    *,
    candidates: int = 8,
    reward: str = "held",
    cost: float = 0.0,
    autoreset_mode: str = "NextStep",
    **options: Any,
) -> "TableVectorEnv":
    """`Holdfast/GraspChoice-v0` over a table for many environments at once, in NumPy.

    Args:
        num_envs: how many.
        candidates: see `make_grasp_choice`, as are the others.
        reward: of the choice.
        cost: of the choice.
        autoreset_mode: see `TableVectorEnv`.
        options: of the table.

    Raises:
        InputError: an option that can't be used.
    """
    return environment.TableVectorEnv(
        _table(options, make_grasp_choice_vector),
        num_envs,
        candidates=candidates,
        reward=_reward(reward, cost),
        autoreset_mode=autoreset_mode,
    )


def make_grasp_choice_sequential_vector(
    num_envs: int = 1,
    *,
    tries: int = _USUAL_TRIES,
    candidates: int = 8,
    reward: str = "held",
    cost: float = 0.0,
    autoreset_mode: str = "NextStep",
    **options: Any,
) -> "TableVectorEnv":
    """`Holdfast/GraspChoiceSequential-v0` over a table for many environments at once, in NumPy.

    Args:
        num_envs: how many.
        tries: at least two.
        candidates: see `make_grasp_choice`, as are the others.
        reward: of each try.
        cost: of each try.
        autoreset_mode: see `TableVectorEnv`.
        options: of the table.

    Raises:
        InputError: an option that can't be used.
    """
    check_whole_number("tries", tries, least=2)
    return environment.TableVectorEnv(
        _table(options, make_grasp_choice_sequential_vector),
        num_envs,
        candidates=candidates,
        tries=tries,
        reward=_reward(reward, cost),
        autoreset_mode=autoreset_mode,
    )


def _backend(name: str, options: dict[str, Any], maker: Callable[..., Any]) -> "Table | Physics":
    if name not in _BACKENDS:
        raise UnknownName("backend", "", "back end", str(name), _BACKENDS)
    _check_options(name, options, maker)
    found: Table | Physics = getattr(environment, _BACKENDS[name])(**options)
    return found


def _check_options(backend: str, options: Iterable[str], maker: Callable[..., Any]) -> None:
    """Looks whether a back end has the options; a misspelt one may be meant for whoever makes it, too.

    Raises:
        InputError: it has not.
    """
    own = _parameters(getattr(environment, _BACKENDS[backend]))
    for option in options:
        if option in own:
            continue
        for other, name in _BACKENDS.items():
            if other != backend and option in _parameters(getattr(environment, name)):
                raise InputError(option, "", f"goes with backend={other!r}, not {backend!r}")
        raise UnknownName(f"backend {backend!r}", "", "option", option, (*_parameters(maker), *own))


def _check_of_one_task(backend: str, reward: str, cost: float, options: Iterable[str]) -> None:
    """Looks whether the environment of one task has what is asked for.

    Raises:
        InputError: it has not.
    """
    for name, given in (("backend", backend), ("reward", reward), ("cost", cost)):
        if given != signature(make_grasp_choice).parameters[name].default:
            raise InputError(name, "", "can't be given together with a task")
    known = _parameters(environment.GraspChoiceEnv)
    for option in options:
        if option not in known:
            raise UnknownName("environment of one task", "", "option", option, known)


def _parameters(made: Callable[..., Any]) -> tuple[str, ...]:
    """Names that may be given to whoever makes something."""
    return tuple(
        name for name, one in signature(made).parameters.items() if one.kind is not Parameter.VAR_KEYWORD
    )


def _table(options: dict[str, Any], maker: Callable[..., Any]) -> "Table":
    if options.pop("backend", "table") != "table":
        raise InputError(
            "backend",
            "",
            "must be 'table' in NumPy's vector; physics takes vectorization_mode 'sync' or 'async'",
        )
    _check_options("table", options, maker)
    return environment.Table(**options)


def _reward(kind: str, cost: float) -> Reward:
    return Reward(kind, cost)  # type: ignore[arg-type]  # it looks itself


def __getattr__(name: str) -> Any:
    if name in ("FRICTIONS", "WEIGHTS", "GraspChoiceEnv"):
        return getattr(environment, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
