"""Runs learning.py in a process of its own, on one thread: what is learned then does not depend on other tests."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path


def test_training_halves_the_loss_on_unseen_clips_and_needs_the_right_sketches() -> None:
    learning = Path(__file__).with_name("learning.py")
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(learning)],
        cwd=learning.parents[3],
        env=os.environ | {"OMP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == 0, done.stdout[-3000:]
    assert "1 passed" in done.stdout
