"""Estimators of the Hurst exponent of a surface, one file each: a new file adds an estimator.

A file has its curve, its known bias and ``ESTIMATOR``, its
:class:`roughness.estimator.Estimator`; the file's name is the estimator's. Tables, figures and
experiments take all files of the folder (:data:`roughness.registry.ESTIMATORS`).
"""
