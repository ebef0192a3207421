# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Write the files that repeat declarations, where they differ from them, and print their names."""

from __future__ import annotations

from tools.tables.documents import files

if __name__ == '__main__':
    for path, text in files().items():
        if path.read_text(encoding='utf-8') != text:
            path.write_text(text, encoding='utf-8')
            print(path)
