"""Estimators of the Hurst exponent of a surface, one file each: a new one is a new file.

A file has its curve, what is known of its bias and ``ESTIMATOR``, its
:class:`roughness.estimator.Estimator`; the file's name is the estimator's. Tables, figures and
experiments take all that are there (:data:`roughness.registry.ESTIMATORS`).
"""
