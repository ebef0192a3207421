# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""An address as a QR code, for the cameras of phones and tablets."""

from __future__ import annotations

import io

# Width of a module, and of the quiet zone around the code, in modules (ISO/IEC 18004: 4).
_SCALE, _QUIET = 8, 4


def qr_code(address: str) -> bytes:
    """
    Return the QR code of an address, as SVG.

    :raises ImportError: segno is not installed
    """
    # An extra: a node without a class does not need it.
    import segno  # noqa: PLC0415 - see above

    image = io.BytesIO()
    code = segno.make(address, micro=False)
    code.save(image, kind='svg', scale=_SCALE, border=_QUIET, dark='#000', light='#fff')
    return image.getvalue()
