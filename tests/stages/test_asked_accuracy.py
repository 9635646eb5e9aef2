"""The error of the closure that a study asks for, beside which the page shows the grid's."""

from fractalcontact.stages.closure_and_box_counts import requested_accuracy
from fractalcontact.study.configuration import solver_settings


def test_a_study_that_asks_for_all_states_is_compared_with_the_usual_error():
    def error(study):
        _, value, attrs = requested_accuracy(solver_settings(study, "study"))["closure_accuracy"]
        assert attrs["units"] == "1"
        return value

    assert error({"accuracy": {"closure": "5 %"}}) == 0.05
    assert error({"accuracy": "full"}) == error({}) == solver_settings({}, "").accuracy["closure"]
