"""Names of the files of the result page: known to the workflow, which imports nothing heavy."""

#: In the folder of the results of a study.
INDEX, EXPLORER = "index.html", "explorer.html"
SUMMARY, CURVES, TABLES, CONFIGURATION = "summary.csv", "curves.csv", "tables.zip", "study.yaml"
#: Those made with the index.
FILES = (INDEX, SUMMARY, CURVES, TABLES, CONFIGURATION)
#: Page of a specimen, below that folder.
SPECIMEN_PAGE = "pages/{specimen}.html"
#: Card of a specimen, and the endings that it has.
CARD, CARD_ENDINGS = "cards/{specimen}.{ending}", ("yaml", "json", "html")
