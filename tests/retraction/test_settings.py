"""Thresholds and budgets that can't be used are refused."""

import pytest
from holdfast.errors import InputError
from holdfast.retraction import RetractionSettings


@pytest.mark.parametrize("field", ["depth_m", "contact_depth_m", "margin_m", "restarts", "max_steps", "seed"])
def test_settings_below_zero_are_refused(field):
    with pytest.raises(InputError, match=f"RetractionSettings.{field}: must be .* of at least 0, not -1"):
        RetractionSettings(**{field: -1})


@pytest.mark.parametrize("value", [0.0, float("nan")])
def test_trust_region_must_have_room(value):
    with pytest.raises(InputError, match=r"RetractionSettings\.trust_m: must be a finite number above 0"):
        RetractionSettings(trust_m=value)
