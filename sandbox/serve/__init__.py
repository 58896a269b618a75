"""Scenes for every browser in the room: the computing stays on this machine.

From the outside in::

    server      the address, the token, QR code; runs until Ctrl-C
    app         pages and WebSockets, checks of host, origin and token, headers
    connection  one browser: reads its messages at a limited rate, sends it the newest of each kind
    room        who is there, what is played, who shot what: it passes messages on and asks for computing
    processes   processes that compute: one job of a kind a player, the newest wins, long ones never block short ones
    calls       what they are asked for, by name: nothing of a scene is imported in the server's own process
    work        how it is computed there
    messages    what a browser may say
    limits      every limit, with its reason
"""
