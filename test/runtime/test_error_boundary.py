# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Refusals pass the boundary; other errors are logged once, counted and answered."""

from physsim_ros.model.errors import BadSize, Failed, PhysSimError, StepFailed
from physsim_ros.runtime.error_boundary import ErrorBoundary
import pytest


def fail(text: str = '', depth: int = 0) -> None:
    if depth:
        fail(text, depth - 1)
    raise KeyError(text)


def test_an_error_is_logged_with_its_traceback_and_answered_with_its_number():
    log: list[str] = []
    boundary = ErrorBoundary(log.append)
    with pytest.raises(Failed, match='failure 1 in the log') as refused, boundary.message('~/it'):
        fail('why')
    assert refused.value.code == 'failed'
    assert isinstance(refused.value.__cause__, KeyError)
    (text,) = log
    assert text.startswith('failure 1, ~/it:\nTraceback')
    assert 'in fail' in text
    assert text.endswith("KeyError: 'why'")


def test_the_errors_of_a_place_are_counted_and_logged_once():
    log: list[str] = []
    boundary = ErrorBoundary(log.append)
    messages = set()
    for depth in range(9):
        with pytest.raises(Failed) as refused, boundary.refusing('~/it'):
            fail(f'number {depth}', depth)
        messages.add(str(refused.value))
    with pytest.raises(Failed, match='failure 10'), boundary.refusing('~/it'):
        raise ZeroDivisionError
    # In `fail` an error comes by two lines or by one.
    assert len(messages) == 2
    assert (boundary.failures, len(log)) == (10, 3)


@pytest.mark.parametrize('error', [BadSize('no'), PhysSimError('no'), StepFailed(), SystemExit()])
def test_what_is_expected_passes(error):
    boundary = ErrorBoundary(pytest.fail)
    with pytest.raises(type(error)), boundary.message('~/it'):
        raise error
    assert boundary.failures == 0


def test_an_output_that_fails_is_an_event_once():
    boundary = ErrorBoundary(lambda _: None)
    for _ in range(3):
        with boundary.containing('~/poses'):
            fail()
    (event,) = boundary.take_events()
    assert (event.topic, event.code) == ('~/poses', 'failed')
    assert boundary.take_events() == ()
    assert boundary.failures == 3


def test_an_error_inside_of_a_step_passes_an_output_too():
    boundary = ErrorBoundary(pytest.fail)
    with pytest.raises(StepFailed), boundary.containing('~/poses'):
        raise StepFailed


def test_without_a_log_errors_pass():
    boundary = ErrorBoundary()
    for block in (boundary.message, boundary.refusing, boundary.containing):
        with pytest.raises(KeyError), block('~/it'):
            fail()


def test_a_log_shows_no_control_character_of_a_stranger():
    log: list[str] = []
    with ErrorBoundary(log.append).containing('~/it'):
        raise ValueError('\x1b[2J' + 'x' * 10_000)
    assert all(line.isprintable() for line in log[0].splitlines())
    assert len(log[0]) < 2000


def test_the_message_that_took_the_longest_is_known():
    times = iter([0.0, 1.0, 1.0, 4.0, 4.0, 6.0, 6.0, 6.5])
    boundary = ErrorBoundary(pytest.fail, lambda: next(times))
    for name in ('~/spawn', '~/stroke', '~/join'):
        with boundary.message(name):
            pass
    assert boundary.take_longest() == ('~/stroke', 3.0)
    with boundary.message('~/pin'):
        pass
    assert boundary.take_longest() == ('~/pin', 0.5)
    assert boundary.take_longest() == ('', 0.0)
