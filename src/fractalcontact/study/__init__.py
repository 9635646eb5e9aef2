"""A study: its configuration, scan files, list of figures, and the atlas."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "ARMS": ".size_tasks",
        "STAGES": ".atlas",
        "SizeTask": ".size_tasks",
        "accuracy_figures_of": ".figure_list",
        "all_figures": ".figure_list",
        "check_study": ".checks",
        "embedded_surface": ".embedded",
        "figures_of": ".figure_list",
        "folder_notes": ".scan_files",
        "is_contact_map": ".sidecar",
        "list_scans": ".scan_files",
        "prepare_specimen": ".preparation",
        "read_atlas": ".atlas",
        "read_sidecar": ".checks",
        "read_study": ".documents",
        "refuse_idle_keys": ".idle_keys",
        "resolve_embedded": ".configuration",
        "resolve_roll_off": ".configuration",
        "resolve_settings": ".configuration",
        "resolve_study": ".checks",
        "sidecar_of_matrix": ".sidecar",
        "size_jobs": ".size_tasks",
        "solver_settings": ".configuration",
        "specimen_memory": ".memory",
        "study_figures_of": ".figure_list",
        "study_name": ".documents",
        "window_arguments": ".configuration",
        "with_coordinates": ".checks",
        "write_atlas": ".atlas",
        "write_scan": ".embedded",
    },
)
