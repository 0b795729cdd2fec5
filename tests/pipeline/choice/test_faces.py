"""What a face promises is there, though it is imported when it is asked for."""

import holdfast.pipeline.choice
import holdfast.pipeline.env
import holdfast.pipeline.environment
import pytest

FACES = (holdfast.pipeline.choice, holdfast.pipeline.environment, holdfast.pipeline.env)


@pytest.mark.parametrize("face", FACES)
def test_every_name_is_there_and_no_module_in_its_place(face: object) -> None:
    for name in face.__all__:
        found = getattr(face, name)
        assert type(found).__name__ != "module", name
    with pytest.raises(AttributeError, match="no_such"):
        _ = face.no_such_name
