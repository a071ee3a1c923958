"""MkDocs hook: links to files outside of docs/ become the file's name, since a site does not have them."""
import posixpath
import re

LINK = re.compile(r"\[([^\]]*)\]\(([^)#\s]+)(#[^)]*)?\)")


def on_page_markdown(markdown, page, config, files):
    folder = posixpath.dirname(page.file.src_uri)
    known = {file.src_uri for file in files}

    def replace(match):
        text, target, anchor = match.group(1), match.group(2), match.group(3) or ""
        if "://" in target:
            return match.group(0)
        path = posixpath.normpath(posixpath.join(folder, target))
        if path in known:
            return match.group(0)
        outside = posixpath.normpath(posixpath.join("docs", path))
        return text if text.strip("`") == outside else f"{text} (`{outside}`)"

    return LINK.sub(replace, markdown)
