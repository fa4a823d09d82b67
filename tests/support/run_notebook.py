"""Runs a notebook where it stands open, in LANGER_PROJECT, and writes what came out: run_notebook.py in.ipynb out.ipynb"""
import os
import sys

import nbclient
import nbformat

book = nbformat.read(sys.argv[1], as_version=4)
nbclient.NotebookClient(book, timeout=300, kernel_name="python3", resources={"metadata": {"path": os.environ["LANGER_PROJECT"]}}).execute()
nbformat.write(book, sys.argv[2])
codes = [cell for cell in book.cells if cell.cell_type == "code"]
progress = any("<progress" in str(output) for cell in codes for output in cell.outputs)
print(f"{len(codes)} cells, {sum(bool(cell.outputs) for cell in codes)} with output, progress {'shown' if progress else 'not shown'}")
