"""What a record calls an input outlives the names of our classes."""

from __future__ import annotations

from typing import get_args

from gcs.session.inputs import TAGS, Input


def test_every_input_has_a_tag_of_its_own() -> None:
    assert set(TAGS) == set(get_args(Input))
    assert len(set(TAGS.values())) == len(TAGS)
