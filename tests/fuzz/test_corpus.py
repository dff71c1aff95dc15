"""The inputs of the corpus end no node, and are dropped with their reason."""

from pathlib import Path

import pytest

from fuzz import corpus
from fuzz.subjects import SUBJECTS, running


@pytest.mark.parametrize("entry", corpus.MESSAGES, ids=lambda each: each.name)
def test_messages(entry: corpus.HostileMessage) -> None:
    kind = type(entry.message)
    for subject in SUBJECTS:
        if entry.dropped_by is not None and subject.name != entry.dropped_by[0]:
            continue
        with running(subject) as (graph, node, feed):
            topics = {(each.topic_name, each.msg_type) for each in node.subscriptions}
            if (entry.topic, kind) not in topics:
                continue
            for _ in range(3):
                graph.publish(entry.topic, entry.message, latched=True)
                graph.run_for(0.3)
            if entry.dropped_by is not None:
                counts = node.dropped_inputs  # type: ignore[attr-defined]
                assert counts[entry.topic, entry.dropped_by[1]] == 3
            feed.all()
            graph.run_for(0.5)


def test_the_script_writes_the_corpus(tmp_path: Path) -> None:
    count = corpus.write(tmp_path)
    assert count == len(list(tmp_path.iterdir()))
