"""What tests in Python share: running programs, and failing with a reason."""

import subprocess
import sys


def check(good, what):
    if not good:
        sys.exit(f"failed: {what}")


def run(*words, codes=(0,), **options):
    """Standard output of a program that ends with one of `codes`; else ends the test."""
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **options)
    if done.returncode not in codes:
        sys.exit(f"failed with code {done.returncode}: {' '.join(map(str, words))}\n"
                 f"{done.stdout}{done.stderr}")
    return done.stdout
