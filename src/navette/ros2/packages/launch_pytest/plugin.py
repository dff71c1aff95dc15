"""pytest plugin: ``@pytest.mark.launch(fixture=…)`` runs a test beside a launch."""

import asyncio
import inspect
from typing import Any

import pytest

from navette.ros2.packages.launch_pytest.fixture import OPTIONS
from navette.ros2.packages.launch_pytest.running_launch import RunningLaunch

_SCOPES: dict[str, Any] = {
    "class": pytest.Class,
    "module": pytest.Module,
    "package": pytest.Package,
    "session": pytest.Session,
}
_LAUNCHES = pytest.StashKey[dict[int, tuple[Any, RunningLaunch]]]()


class LaunchPlugin:
    """Hooks and fixtures of launch tests."""

    @pytest.hookimpl(tryfirst=True)
    def pytest_configure(self, config: Any) -> None:
        config.addinivalue_line(
            "markers", "launch(fixture, shutdown): run a test beside a launch"
        )

    @pytest.hookimpl(tryfirst=True)
    def pytest_pycollect_makeitem(self, collector: Any, name: str, obj: Any) -> Any:
        # pytest itself refuses tests with `yield`.
        marks = [mark.name for mark in getattr(obj, "pytestmark", ())]
        if _yields(obj) and "launch" in marks and collector.istestfunction(obj, name):
            return list(collector._genfunctions(name, obj))
        return None

    @pytest.hookimpl(trylast=True)
    def pytest_runtest_setup(self, item: Any) -> None:
        if _marker(item) is not None:
            _running(item._request)

    @pytest.hookimpl(tryfirst=True)
    def pytest_pyfunc_call(self, pyfuncitem: Any) -> bool | None:
        marker = _marker(pyfuncitem)
        if marker is None:
            return None
        launch = _running(pyfuncitem._request)
        if marker.kwargs.get("shutdown") or _options(marker)["shutdown"]:
            if _yields(pyfuncitem.obj):
                pytest.fail(
                    "a generator or async generator is not a test of a launch with "
                    "shutdown=True: what follows its yield runs after the shutdown",
                    pytrace=False,
                )
            launch.shut_down()
        names = pyfuncitem._fixtureinfo.argnames
        arguments = {name: pyfuncitem.funcargs[name] for name in names}
        _call(pyfuncitem.obj, arguments, launch)
        return True

    @pytest.fixture
    def launch_service(self, request: Any) -> Any:
        """The service of the launch beside the test."""
        return _running(request).service

    @pytest.fixture
    def launch_context(self, request: Any) -> Any:
        """The context of the launch beside the test."""
        return _running(request).service.context


def _yields(function: Any) -> bool:
    return inspect.isgeneratorfunction(function) or inspect.isasyncgenfunction(function)


def _marker(item: Any) -> Any:
    return item.get_closest_marker("launch")


def _fixture_of(marker: Any) -> Any:
    found = marker.kwargs.get("fixture", marker.args[0] if marker.args else None)
    if not hasattr(found, OPTIONS):
        raise pytest.UsageError(
            "@pytest.mark.launch(fixture=…): expected a function with "
            f"@launch_pytest.fixture, got {found!r}"
        )
    return found


def _options(marker: Any) -> dict[str, Any]:
    options: dict[str, Any] = getattr(_fixture_of(marker), OPTIONS)
    return options


def _running(request: Any) -> RunningLaunch:
    """Return the launch of a test; the first test of its scope starts it."""
    item = request.node
    marker = _marker(item)
    if marker is None:
        raise pytest.UsageError("the test needs @pytest.mark.launch(fixture=…)")
    value = request.getfixturevalue(_fixture_of(marker).__name__)
    scope = _SCOPES.get(_options(marker)["scope"])
    owner = item if scope is None else item.getparent(scope)
    launches = owner.stash.setdefault(_LAUNCHES, {})
    if id(value) not in launches:
        launch = RunningLaunch(value)
        launches[id(value)] = (value, launch)
        if _options(marker)["auto_shutdown"] or scope is None:
            owner.addfinalizer(launch.shut_down)
        launch.start()
    return launches[id(value)][1]  # type: ignore[no-any-return]


def _call(function: Any, arguments: dict[str, Any], launch: RunningLaunch) -> None:
    """Run a test; what follows its ``yield`` runs after the shutdown."""
    if inspect.isasyncgenfunction(function):
        asyncio.run(_call_async_generator(function(**arguments), launch))
    elif inspect.iscoroutinefunction(function):
        asyncio.run(function(**arguments))
    elif inspect.isgeneratorfunction(function):
        steps = function(**arguments)
        next(steps, None)
        launch.shut_down()
        for _ in steps:
            _yielded_twice()
    else:
        function(**arguments)


async def _call_async_generator(steps: Any, launch: RunningLaunch) -> None:
    await anext(steps, None)
    await asyncio.to_thread(launch.shut_down)
    async for _ in steps:
        _yielded_twice()


def _yielded_twice() -> None:
    pytest.fail("a launch test must stop iteration after yielding once", pytrace=False)
