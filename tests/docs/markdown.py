"""What the documents' tests need of Markdown: fenced blocks with their marks, links, headings."""
import dataclasses
import pathlib
import re

FENCE = re.compile(r"^```(\S*)\s*$")
OTHER_FENCE = re.compile(r"^(\s+```|\s*~~~)")
MARK = re.compile(r"^<!--\s*(?P<name>[^:>]+?)\s*(?::\s*(?P<value>.*?))?\s*-->$")


@dataclasses.dataclass
class Block:
    """A fenced block. `marks` are the comments `<!-- name: value -->` on the lines before it."""

    language: str
    line: int  # of the opening fence, from 1
    text: str
    marks: dict


def read_blocks(text):
    """All fenced blocks in order; ValueError where a fence stays open, is indented or of tildes."""
    blocks = []
    marks = {}
    opened = None
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line)
        if opened is None and OTHER_FENCE.match(line):
            raise ValueError(f"line {number}: a block begins with ``` at the margin")
        if opened is None:
            mark = MARK.match(line)
            if fence:
                opened = Block(fence.group(1), number, "", marks)
            elif mark:
                marks[mark.group("name")] = mark.group("value") or ""
                continue
            marks = {}
        elif line == "```":
            blocks.append(opened)
            opened = None
        else:
            opened.text += line + "\n"
    if opened is not None:
        raise ValueError(f"line {opened.line}: the block is not closed")
    return blocks


def drop_blocks(text):
    """The text with empty lines in place of its fenced blocks."""
    inside = False
    lines = []
    for line in text.splitlines():
        fence = line.startswith("```")
        lines.append("" if inside or fence else line)
        inside ^= fence
    return "\n".join(lines)


def list_anchors(text):
    """Anchors of all headings, as GitHub makes them."""
    anchors = set()
    for heading in re.findall(r"^#+ +(.*?) *$", drop_blocks(text), re.M):
        heading = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading)
        slug = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        count = 0
        while (f"{slug}-{count}" if count else slug) in anchors:
            count += 1
        anchors.add(f"{slug}-{count}" if count else slug)
    return anchors


# A path of the sources, in prose or in backticks.
PATH = re.compile(
    r"(?<![\w/.-])((?:model|io|sweep|train|diagnose|jobs|tests|docs|examples|benchmarks|\.ci)"
    r"/[\w./-]*\w)/?(?![\w*/-]|\.\w)"
)


def find_broken_references(file, root):
    """What is wrong with the links and paths of one document, a sentence each."""
    file = pathlib.Path(file)
    text = file.read_text(encoding="utf-8")
    prose = drop_blocks(text)
    wrong = []
    for target in re.findall(r"\]\(([^()\s]+)(?: +\"[^\"]*\")?\)", prose):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        linked = (file.parent / path) if path else file
        if not linked.exists():
            wrong.append(f"the link {target} leads to no file")
        elif anchor and anchor not in list_anchors(linked.read_text(encoding="utf-8")):
            wrong.append(f"the link {target} leads to no heading")
    for path in sorted(set(PATH.findall(re.sub(r"\]\([^()\s]+\)", "]", prose)))):
        has_capitals = re.search(r"(?<![A-Za-z])[A-Z]{2,}(?![A-Za-z])", path)  # tests/NAME_test.cc
        is_form = has_capitals and not path.endswith((".md", ".txt"))
        if not is_form and not (root / path).exists():
            wrong.append(f"there is no {path}")
    return wrong
