"""Names of the files of the result page: known to the workflow, which imports nothing heavy."""

#: Pages, tables, their archive and the study, in the folder of the study's results.
INDEX, EXPLORER = "index.html", "explorer.html"
SUMMARY, CURVES, STATEMENTS = "summary.csv", "curves.csv", "statements.csv"
TABLES, CONFIGURATION = "tables.zip", "study.yaml"
#: Files made with the index.
FILES = (INDEX, SUMMARY, CURVES, STATEMENTS, TABLES, CONFIGURATION)
#: Page of a specimen, below that folder.
SPECIMEN_PAGE = "pages/{specimen}.html"
#: Aperture map of a specimen under the reference load, and the endings that it has.
APERTURE, APERTURE_ENDINGS = "apertures/{specimen}.{ending}", ("csv", "nc", "vtk")
#: Card of a specimen, and its endings.
CARD, CARD_ENDINGS = "cards/{specimen}.{ending}", ("yaml", "json", "html")
