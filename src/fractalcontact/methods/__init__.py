"""Other solvers of the same contact problem, for comparison only.

Each module offers ``solve_contact(composite, space, ...)`` with the call, the result and the errors
of `fractalcontact.solve_contact`.
"""
