"""Journeys and curves made by hand, and how to look at a figure."""

import pytest
from fake_journeys import make_journey, make_line


@pytest.fixture
def line():
    return make_line()


@pytest.fixture
def journeys(line):
    """Return three trains: one each way, and one that does not get to its end."""
    return [
        make_journey(line, "1"),
        make_journey(line, "IC 22/1", backwards=True, start_s=6 * 3600 + 200.0),
        make_journey(line, "33", stuck_m=8000.0, start_s=6 * 3600 + 400.0),
    ]


@pytest.fixture
def no_overlap():
    """Return a check that none of some texts lies on another, as drawn."""

    def check(figure, texts):
        figure.canvas.draw()
        boxes = [text.get_window_extent() for text in texts if text.get_visible() and text.get_text()]
        assert len(boxes) > 1
        for number, box in enumerate(boxes):
            assert not any(box.overlaps(other) for other in boxes[number + 1 :])
            assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1
            assert figure.bbox.y0 <= box.y0 < box.y1 <= figure.bbox.y1

    return check
