#!/usr/bin/env python3
"""Which lines the tests ran: coverage.py ROOT BUILD

Reads what a build with PERCALE_COVERAGE left behind after its tests (by `gcov --json-format`),
prints the share of lines per folder, and writes BUILD/report.html with every file and the lines
that never ran.
"""

import html
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

# What is reported: the product, not its tests.
FOLDERS = ["include", "src", "io", "render", "apps", "bench"]


def find_data(build):
    """The .gcda files of a build, one per compiled source that ran."""
    return sorted(os.path.join(folder, file) for folder, _, files in os.walk(build) for file in files
                  if file.endswith(".gcda"))


def gcov(data):
    """gcov's reports for one .gcda file: a list of documents."""
    done = subprocess.run(["gcov", "--json-format", "--stdout", os.path.basename(data)],
                          cwd=os.path.dirname(data), capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"gcov could not read {data}: {done.stderr.strip()}")
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def collect(root, build):
    """{file: {line: times run}} for the files of the project, summed over all programs."""
    root = os.path.realpath(root)
    files = {}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for documents in pool.map(gcov, find_data(build)):
            for document in documents:
                for entry in document["files"]:
                    path = os.path.realpath(os.path.join(document["current_working_directory"], entry["file"]))
                    path = os.path.relpath(path, root).replace(os.sep, "/")
                    if path.split("/")[0] not in FOLDERS:
                        continue
                    lines = files.setdefault(path, {})
                    for line in entry["lines"]:
                        number = line["line_number"]
                        lines[number] = lines.get(number, 0) + line["count"]
    return files


def folder_of(path):
    """The room of a file: two levels where rooms have subfolders."""
    parts = path.split("/")
    return "/".join(parts[:2]) if len(parts) > 2 else parts[0]


def ranges(numbers):
    """[1, 2, 3, 7] as "1-3, 7"."""
    text = []
    for number in sorted(numbers):
        if text and text[-1][1] == number - 1:
            text[-1][1] = number
        else:
            text.append([number, number])
    return ", ".join(str(a) if a == b else f"{a}-{b}" for a, b in text)


def percent(ran, count):
    return 100.0 * ran / count if count else 100.0


def summarise(files):
    """[(folder, lines run, lines)], and their sum as the last row."""
    rows = {}
    for path, lines in files.items():
        row = rows.setdefault(folder_of(path), [0, 0])
        row[0] += sum(1 for count in lines.values() if count)
        row[1] += len(lines)
    table = [(folder, *row) for folder, row in sorted(rows.items())]
    return table + [("all", sum(row[1] for row in table), sum(row[2] for row in table))]


def write_html(files, table, target):
    rows = ["<!doctype html><meta charset=utf-8><title>Line coverage</title>"
            "<style>body{font:14px sans-serif;margin:2em}td,th{padding:2px 12px;text-align:right;vertical-align:top}"
            "td:first-child,th:first-child,td:last-child{text-align:left}td:last-child{color:#666;max-width:50em}</style>"
            "<h1>Line coverage</h1><table><tr><th>folder<th>lines<th>run<th>%</tr>"]
    for folder, ran, count in table:
        rows.append(f"<tr><td>{html.escape(folder)}<td>{count}<td>{ran}<td>{percent(ran, count):.1f}</tr>")
    rows.append("</table><h2>Files</h2><table><tr><th>file<th>lines<th>%<th>lines that never ran</tr>")
    for path, lines in sorted(files.items()):
        missed = [number for number, count in lines.items() if not count]
        rows.append(f"<tr><td>{html.escape(path)}<td>{len(lines)}"
                    f"<td>{percent(len(lines) - len(missed), len(lines)):.1f}<td>{ranges(missed)}</tr>")
    rows.append("</table>\n")
    temporary = target + ".part"
    with open(temporary, "w", encoding="utf-8") as file:
        file.write("\n".join(rows))
    os.replace(temporary, target)


def main():
    if len(sys.argv) != 3:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    root, build = sys.argv[1:]
    files = collect(root, build)
    if not files:
        print(f"{build}: found no record of lines that ran; build with -DPERCALE_COVERAGE=ON (g++) and run the tests",
              file=sys.stderr)
        return 1
    table = summarise(files)
    print(f"{'folder':<16}{'lines':>8}{'run':>8}{'%':>8}")
    for folder, ran, count in table:
        print(f"{folder:<16}{count:>8}{ran:>8}{percent(ran, count):>8.1f}")
    target = os.path.join(build, "report.html")
    write_html(files, table, target)
    print(f"every file: {target}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
