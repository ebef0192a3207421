# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Delays of what pages are told and send, as over a slow network; the environment asks for them.

`PAGE_DELAYS='{"frame": 0.05, "answer": 0.5, "sent": 0.2}'` are shares of the messages of a type,
which are held up for 50 to 300 ms, and all behind them: the order stays. `sent` are those of the
page. What a test, or the page, does not wait for shows at once. Frames and timelines come often:
delays of more than a second in a second leave a page behind for ever.
"""

from __future__ import annotations

import os

SHARES = os.environ.get('PAGE_DELAYS', '')
_SCRIPT = """
const shares = SHARES;
const inTurn = (deliver) => {
    let last = Promise.resolve();
    const pause = () => new Promise((done) => setTimeout(done, 50 + 250 * Math.random()));
    return (type, item) => {
        last = last.then(() => Math.random() < (shares[type] ?? 0) ? pause() : null)
            .then(() => deliver(item));
    };
};
window.WebSocket = class extends WebSocket {
    constructor(...words) {
        super(...words);
        this.listeners = [];
        const tell = inTurn((event) => this.listeners.forEach((each) => each.call(this, event)));
        super.addEventListener('message', (event) =>
            tell(typeof event.data === 'string' ? JSON.parse(event.data).type : 'frame', event));
        const send = inTurn((text) => this.readyState === WebSocket.OPEN && super.send(text));
        this.send = (text) => send('sent', text);
    }

    addEventListener(type, listener) {
        if (type === 'message') this.listeners.push(listener);
        else super.addEventListener(type, listener);
    }

    set onmessage(listener) {
        this.listeners.push(listener);
    }
};"""
# Of a page before its own scripts; '' delays nothing.
DELAYS = _SCRIPT.replace('SHARES', SHARES) if SHARES else ''
