#!/usr/bin/env python3
"""Is the driver of the documents' snippets able to fail? One document for each thing that may be wrong.

  run_snippets_test.py STRUT
"""
import pathlib
import subprocess
import sys
import tempfile

DRIVER = pathlib.Path(__file__).with_name("run_snippets.py")


def fence(language, text):
    return f"```{language}\n{text}\n```\n"


def show(command, output, marks=""):
    return fence("sh", command) + f"\n{marks}" + fence("text", output)


# What is wrong, the document, and what must be said of it; nothing: nothing is wrong.
DOCUMENTS = {
    "all is well": (show("echo one; echo two; echo three >&2", "one\n...\nthree"), ""),
    "a part of a line": (show("echo took 3.4 s", "took ... s"), ""),
    "another output": (show("echo one", "two"), "no such line where it is expected: two"),
    "more output": (show("echo one; echo two", "one"), "no such line where it is expected: (the end)"),
    "less output": (show("echo one", "one\ntwo"), "expected: two"),
    "an order": (show("echo two; echo one", "one\n...\ntwo"), "expected: one"),
    "numbers are near": (
        show("echo x 1.1 m", "x 1.0 m", "<!-- numbers within a factor of: 1.2 -->\n"), ""),
    "numbers are far": (
        show("echo x 1.3 m", "x 1.0 m", "<!-- numbers within a factor of: 1.2 -->\n"), "x 1.0 m"),
    "a sign": (
        show("echo x -1.0 m", "x 1.0 m", "<!-- numbers within a factor of: 1.2 -->\n"), "x 1.0 m"),
    "an exit code": (fence("sh", "exit 3"), "ended with exit code 3"),
    "a failing first command": (fence("sh", "false\ntrue"), "ended with exit code 1"),
    "an expected exit code": ("<!-- exit code: 3 -->\n" + fence("sh", "exit 3"), ""),
    "an expected exit code that does not come": (
        "<!-- exit code: 3 -->\n" + fence("sh", "true"), "ended with exit code 0"),
    "a command": ("<!-- not run: no -->\n" + fence("sh", "strut simulat a b"), "no command simulat"),
    "an option": (
        "<!-- not run: no -->\n" + fence("sh", "strut run DIR \\\n  --thread 2"), "no option --thread"),
    "an option in prose": ("Call `strut run DIR --fast`.\n", "no option --fast"),
    "an option that is there": ("Call `strut run DIR --threads 2` or `strut plan A -o B`.\n", ""),
    "help": ("Call `strut help run`, `strut help COMMAND`.\n", ""),
    "help on nothing": ("Call `strut help ran`.\n", "no command ran"),
    "an option behind a redirection": (
        "<!-- not run: no -->\n" + fence("sh", "strut run cars > log 2>&1 --thread 2"),
        "no option --thread"),
    "a redirection": ("<!-- not run: no -->\n" + fence("sh", "strut run cars 2>/dev/null >-x"), ""),
    "a mark": ("<!-- notrun: no -->\n" + fence("sh", "true"), "no mark 'notrun'"),
    "needs": ("<!-- needs: moon -->\n" + fence("sh", "true"), "knows slurm only"),
    "a text of what does not run": (
        "<!-- not run: no -->\n" + fence("sh", "echo 1") + "\n" + fence("text", "2"), "does not run"),
    "a layout": ("<!-- layout: a form -->\n" + fence("text", "2"), ""),
    "tildes": ("~~~sh\ntrue\n~~~\n", "at the margin"),
    "an indented fence": ("- a\n  ```sh\n  true\n  ```\n", "at the margin"),
    "a link with a title": ('[x](nowhere.md "t")\n', "leads to no file"),
    "a folder": ("See examples/nosuch/ for more.\n", "there is no examples/nosuch"),
    "a folder that is there": ("See examples/sweeps/ and `examples/sweeps/*.toml`.\n", ""),
    "no reason": ("<!-- not run: -->\n" + fence("sh", "true"), "needs a reason"),
    "a shell's grammar": ("<!-- not run: no -->\n" + fence("sh", "if true"), "bash does not understand"),
    "a text of nobody": (fence("text", "one"), "belongs to no sh block"),
    "an unknown language": (fence("", "strut run"), "nobody here can run"),
    "a block that stays open": ("```sh\ntrue\n", "not closed"),
    "TOML": (fence("toml", "a = = 1"), "not TOML"),
    "JSON": (fence("json", "{'a': 1}"), "not JSON"),
    "Python's grammar": ("<!-- not run: no -->\n" + fence("python", "def"), "not Python"),
    "Python": (fence("python", "import no_such_module"), "ended with exit code 1"),
    "C": (fence("c", "int f(void) { return x; }"), "does not compile"),
    "C++": (fence("cpp", "int f() { return x; }"), "does not compile"),
    "a file": ("<!-- file: a.txt -->\n" + fence("toml", "a = 1") + show("cat a.txt", "a = 1"), ""),
    "a link": ("[x](nowhere.md)\n", "leads to no file"),
    "a heading": ("# Here\n\n[x](#there)\n", "leads to no heading"),
    "a heading that is there": ("# Over here: `x`\n\n[x](#over-here-x)\n", ""),
    "a path": ("In `model/force/nothing.h`.\n", "there is no model/force/nothing.h"),
    "a path in prose": ("In tests/nothing.cc:\n", "there is no tests/nothing.cc"),
}


def main():
    strut = sys.argv[1]
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        sources = pathlib.Path(folder) / "sources"
        (sources / "examples/sweeps").mkdir(parents=True)
        for name, (text, expected) in DOCUMENTS.items():
            document = sources / "document.md"
            document.write_text(text, encoding="utf-8")
            result = subprocess.run(
                [sys.executable, DRIVER, strut, sources, document],
                capture_output=True, text=True, check=False
            )
            code = 1 if expected else 0
            if result.returncode != code or expected not in result.stderr:
                wrong.append(f"{name}: exit code {result.returncode}\n{result.stdout}{result.stderr}")
    print(f"{len(DOCUMENTS)} documents")
    for sentence in wrong:
        print(sentence, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
