"""The transfer of control between clients."""

from voxrt.serve.control_transfer import IDLE_SECONDS, ControlTransfer


def test_one_has_control_and_others_wait():
    now, lost = [0.0], []
    control = ControlTransfer(lambda: now[0], lost.append)
    assert control.request(1)
    assert control.request(1)
    assert not control.request(2)
    assert not control.request(3)
    assert not control.request(2)
    assert control.waiting == (2, 3)
    assert control.use(1)
    assert not control.use(2)
    control.release(1)
    assert (control.controller, control.waiting) == (2, (3,))
    control.release(3)
    control.release(2)
    assert (control.controller, control.waiting) == (None, ())


def test_an_idle_controller_loses_control():
    now, lost = [0.0], []
    control = ControlTransfer(lambda: now[0], lost.append)
    control.request(1)
    now[0] = IDLE_SECONDS
    assert not control.request(2)
    now[0] = IDLE_SECONDS + 1
    assert control.request(2)
    assert control.controller == 2
    assert lost == [1]


def test_control_passes_on_to_who_waits_for_an_idle_controller():
    now, lost = [0.0], []
    control = ControlTransfer(lambda: now[0], lost.append)
    control.request(1)
    control.request(2)
    control.request(3)
    now[0] = IDLE_SECONDS
    assert control.use(1)
    now[0] = 2 * IDLE_SECONDS
    assert not control.pass_on()
    now[0] = 2 * IDLE_SECONDS + 1
    assert control.pass_on()
    assert not control.pass_on()
    assert (control.controller, control.waiting, lost) == (2, (3,), [1])
    control.release(3)
    now[0] = 4 * IDLE_SECONDS
    assert not control.pass_on()  # nobody waits
    control.release(2)
    assert (control.controller, lost) == (None, [1, 2])
