#!/usr/bin/env python3
"""Comments stay easy to read: few phrases that hide their subject, and short sentences. comments.py measures them.

Usage: comments_test.py [unittest arguments]
"""

import unittest

import comments

MAX_PHRASES = 60  # in all comments
MAX_MEAN = 20  # words of a sentence, in each folder
MAX_SHARE = 0.1  # of long sentences, in each file


class Comments(unittest.TestCase):
    def test_phrases_that_hide_their_subject_are_rare(self):
        files, everything = comments.measured(str)
        worst = sorted(((measure.phrases, name) for name, measure in files.items() if measure.phrases), reverse=True)
        self.assertLess(everything.phrases, MAX_PHRASES, worst[:10])

    def test_sentences_are_short_in_every_folder(self):
        folders, _ = comments.measured(comments.folder)
        self.assertGreater(len(folders), 50)
        for name, measure in folders.items():
            self.assertLessEqual(measure.mean, MAX_MEAN, name)

    def test_long_sentences_are_exceptions_in_every_file(self):
        files, everything = comments.measured(str)
        self.assertGreater(everything.sentences, 10_000)
        for name, measure in files.items():
            self.assertLessEqual(measure.long, max(1, MAX_SHARE * measure.sentences), name)


class Measuring(unittest.TestCase):
    """Comments are found in each language, and only comments."""

    def test_comments_of_each_language_are_found(self):
        text = "One that hides."
        found = {
            "a.h": f'const char* s = "// no // {text}";  // {text}\n/// {text}\nint a = 1\'000; /* {text} */\nf(int /*size*/);\n',
            "a.js": f'const s = `// ${{"no"}} {text}`; // {text}\n/** {text} */\nconst r = /["/]/; // {text}\n',
            "a.py": f'"""{text}"""\nS = "# {text}"  # {text}\n\n\ndef f():\n    """{text}"""\n',
            "scripts/a": f'#!/bin/bash\n# {text}\necho "# {text}" \'# {text}\' "${{#A}}"  # {text}\n',
        }
        counts = {name: [comment.text for comment in comments.comments(name, source)] for name, source in found.items()}
        self.assertEqual(counts, {"a.h": [text] * 3, "a.js": [text] * 3, "a.py": [text] * 3, "scripts/a": [text] * 2})

    def test_lines_of_a_comment_are_one_and_lists_have_sentences_of_their_own(self):
        (comment,) = comments.comments("a.h", "// The first ends\n// here, e.g. here. The second is\n// open:\n//\n"
                                              "// - an item\n//   of two lines\n// - another\n//\n//     pseudo code\n")
        self.assertEqual(list(comments.sentences(comment)),
                         ["The first ends here, e.g here.", "The second is open:", "an item of two lines", "another"])

    def test_phrases_are_counted_across_lines_and_sentences_when_they_are_long(self):
        measure = comments.Measure()
        for comment in comments.comments("a.h", "// The sum is that\n// of others.\n\n// " + "word " * 31 + "\n"):
            measure.add(comment)
        self.assertEqual((measure.phrases, measure.sentences, measure.words, measure.long), (1, 2, 37, 1))


if __name__ == "__main__":
    unittest.main()
