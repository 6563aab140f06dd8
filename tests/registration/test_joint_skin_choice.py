# SPDX-License-Identifier: LGPL-2.1-or-later
"""Smooth pieces of surfaces whose pieces are known, and which of two fits of a sheet is chosen on which evidence."""
from types import SimpleNamespace

import numpy as np
import pytest

from ffds_workbench.registration.joint.iteration import State
from ffds_workbench.registration.joint.skins import choose_skin, skin_choice
from ffds_workbench.registration.joint.skins.smooth_pieces import smooth_pieces

THICKNESS = 2.0


def strip(turns, count=6000, seed=0):
    """Points on a closed strip of 12 mm around a circle of 30 mm radius, twisted by half ``turns``; its normals with
    signs at random, and as they are."""
    random = np.random.default_rng(seed)
    angle, across = random.uniform([0, -6], [2 * np.pi, 6], (count, 2)).T
    twist = 0.5 * turns * angle
    out = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(count)])
    wide = np.cos(twist)[:, None] * out + np.sin(twist)[:, None] * [0, 0, 1]
    along = 30.0 * np.column_stack([-np.sin(angle), np.cos(angle), np.zeros(count)]) \
        + across[:, None] * (np.cos(twist)[:, None] * along_of(angle) + 0.5 * turns * (
            np.cos(twist)[:, None] * [0, 0, 1] - np.sin(twist)[:, None] * out))
    normal = np.cross(along, wide)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return 30.0 * out + across[:, None] * wide, normal * random.choice([-1.0, 1.0], count)[:, None], normal


def along_of(angle):
    return np.column_stack([-np.sin(angle), np.cos(angle), np.zeros(len(angle))])


def test_a_ring_has_two_sides_and_one_piece():
    points, given, normal = strip(turns=0)
    piece, side = smooth_pieces(points, given)
    assert len(np.unique(piece)) == 1
    # All signs are those of the piece's one side, whichever.
    agreed = side * np.einsum("nx,nx->n", given, normal)
    assert agreed == pytest.approx(np.full(len(points), agreed[0]))


def test_a_moebius_strip_has_but_one_side():
    points, given, _ = strip(turns=1)
    piece, side = smooth_pieces(points, given)
    assert len(np.unique(piece)) == 1 and not side.any()


def test_skins_and_walls_of_a_plate_are_pieces_of_their_own():
    """Two skins 2 mm apart and a wall between them, points 0.5 mm apart: never linked, over the edge or through it."""
    random = np.random.default_rng(3)
    place = random.uniform(0, [40, 30], (9600, 2))
    skins = np.column_stack([place, np.repeat([0.0, THICKNESS], 4800)])
    wall = np.column_stack([np.zeros(240), random.uniform(0, [30, THICKNESS], (240, 2))])
    normal = np.repeat([[0, 0, 1.0], [1.0, 0, 0]], [9600, 240], axis=0)
    piece, side = smooth_pieces(np.concatenate([skins, wall]), normal)
    groups = [set(piece[:4800]), set(piece[4800:9600]), set(piece[9600:])]
    assert groups[0].isdisjoint(groups[1]) and groups[0].isdisjoint(groups[2]) and groups[1].isdisjoint(groups[2])
    assert [max(np.bincount(piece[part])) / len(piece[part]) for part in (slice(4800), slice(4800, 9600))] == [1, 1]
    assert (side != 0).all()


def chosen(monkeypatch, first, second, told=False):
    """Which of two fits is chosen, 0 or 1, and how far it says the whole may be off; evidence as cost, points matched,
    points on walls, and movement in mm."""
    fits = [State(np.zeros((1, 3)), None, None, iterations=number) for number in (0, 1)]
    evidence = first, second
    monkeypatch.setattr(skin_choice, "_evidence", lambda problem, state: evidence[state.iterations])
    pairs = SimpleNamespace(solid_thickness=(0.0, THICKNESS))
    found = choose_skin(SimpleNamespace(couplings=SimpleNamespace(pairs=pairs)), fits, told)
    return found.iterations, found.unsure


EVEN = (100.0, 1000.0, 400, 1.0)
"""What says as much for the one fit as for the other."""


def test_a_single_fit_is_the_answer():
    fit = State(np.zeros((1, 3)), None, None)
    assert choose_skin(None, [fit], False) is fit


@pytest.mark.parametrize("better", [0, 1])
@pytest.mark.parametrize("evidence", [(50.0, 1000.0, 400, 5.0), (100.0, 1100.0, 400, 5.0), (100.0, 1000.0, 1500, 5.0)],
                         ids=["costs half", "matches more points", "explains the walls"])
def test_what_is_seen_beside_the_skins_counts_first(monkeypatch, evidence, better):
    """However much farther that fit has moved, and whatever the normals say."""
    fits = [EVEN, EVEN]
    fits[better] = evidence
    assert chosen(monkeypatch, *fits, told=better == 1) == (better, 0.0)


@pytest.mark.parametrize("moved, told, wanted", [
    ((1.0, 2.0), False, (0, 0.0)),  # half as far: the sheet did not go through itself
    ((2.0, 1.0), False, (1, 0.0)),
    ((1.0, 1.1), False, (0, THICKNESS)),  # as far: a guess
    ((1.1, 1.0), False, (1, THICKNESS)),
    ((1.0, 1.1), True, (0, 0.0)),  # as far, and the scan's normals tell
    ((1.2, 1.0), True, (0, THICKNESS)),  # a little farther: they may be wrong
    ((2.0, 1.0), True, (1, THICKNESS))])  # far more: they are, perhaps
def test_where_nothing_else_tells_the_nearer_fit_is_a_guess(monkeypatch, moved, told, wanted):
    fits = [(*EVEN[:3], distance) for distance in moved]
    assert chosen(monkeypatch, *fits, told=told) == wanted
