"""One YAML file that stands for itself: a reference case, a vehicle, a train."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from tractionpower.errors import InputError, raise_errors
from tractionpower.io.problems import Input, format_problem, problems_of
from tractionpower.io.shapes import shape_of
from tractionpower.io.text_files import Source
from tractionpower.io.yaml_files import read_yaml

Model = TypeVar("Model", bound=BaseModel)


def read_document(path: Path, model: type[Model]) -> Model:
    """Read one file as a model.

    Raises
    ------
    InputError
        With all problems of the file.
    """
    source = Source(path, path.name, "")
    read = read_yaml(source)
    content = Input(source.root, read.data, read.mark, shape_of(model), path)
    newer = format_problem(content)
    raise_errors([*read.problems, *([newer] if newer else [])])
    try:
        return model.model_validate(content.data)
    except ValidationError as error:
        raise InputError(problems_of(error, content)) from None
