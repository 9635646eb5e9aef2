"""Every variable of the atlas is read by something, or kept for users by the register."""

from named_variables import unread

from fractalcontact.report.published import shown_in


def test_no_variable_is_read_by_its_maker_alone(atlas):
    stored = {
        name
        for title, stage in atlas.children.items()
        if title != "measured"  # its readers take each kind of test by the start of its names
        for group in stage.children.values()
        for name in group.data_vars
    }
    assert len(stored) > 900
    assert unread(stored) == [], unread(stored)
    assert unread(["unheard_of", "unheard_of_low", "area"]) == ["unheard_of", "unheard_of_low"]


def test_what_is_kept_for_who_reads_the_atlas_is_there_with_its_unit(atlas):
    for row in shown_in("shown"):
        groups = atlas[row.stage].children.values()
        found = [one[row.variable] for one in groups if row.variable in one]
        assert found, row.source
        assert {one.attrs["units"] for one in found} == {row.unit}, row.source
