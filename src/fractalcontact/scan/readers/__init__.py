"""Readers of scan files, one module a family of formats; each declares its ``FORMAT``.

They import the libraries that open files within their functions: files are untrusted input and are
read in the reader process alone (`fractalcontact.scan.reader_process`).
"""
