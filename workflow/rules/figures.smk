def collect_figures(wildcards):
    return []
