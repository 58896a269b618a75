"""Every limit of the server: what it protects, and what a player notices."""

from __future__ import annotations

#: Browsers at once: a large class. One more is told that the room is full.
PLAYERS = 60
#: Players who left are remembered so long, in s, to come back to their state; at most four times PLAYERS are.
REMEMBERED = 3600.0
#: The teacher sees who left for so long, in s: a lesson.
AWAY = 2700.0
#: Characters of a name.
NAME = 20
#: Bytes of a message from a browser; a longer one closes its connection.
MESSAGE = 16_384
#: Characters of a key and of a word of a parameter, and how many parameters one message may change.
KEY, WORD, CHANGES = 80, 60, 200
#: Messages per second of one browser, and how many may come at once. What comes faster is not read, and the player is
#: told; after FLOOD such messages the connection is closed.
RATE, BURST, FLOOD = 40.0, 120, 1000
#: Pings per second of one connection, ten times as many at once, and parts of one message: browsers send none, and a
#: message in one part. A connection with more is ended.
PINGS, PARTS = 1.0, 100
#: Messages per second that a browser is told of what was refused.
TOLD = 2.0
#: A run may take so long, in s; it is then ended, and the player is told.
RUN = 8.0
#: The run of a path may take so much processor time, in s; the player is then told to let go, which may take RUN.
PATH = 3.0
#: A fan goes on for so many s of processor time at most: it then has fewer shots.
FAN = 0.8
#: Runs that take longer than this, in s, wait for each other, and never keep others waiting.
LONG = 0.15
#: Bytes of what one run may come to, deflated; a longer one is refused.
RESULT = 2_000_000
#: Memory of a computing process in bytes, beyond which a run fails.
MEMORY = 4 << 30
#: A browser that does not read what it is sent for so many s is disconnected.
UNREAD = 10.0
#: Rows of the teacher's table, of which the page has the last ones; the oldest go first.
ROWS, SENT = 2000, 600
#: A request for a small picture of a shot waits so long, in s; the page asks again.
DRAWN = 1.0
#: The addresses stay valid so long after a start, in s, when the server starts again: a day at school.
KEPT = 12 * 3600.0
#: A connection that has not said what it wants after so many s is closed.
HELLO = 10.0
#: Requests per second of one address for pages and connections, and how many may come at once: a page takes six, and a
#: class may share an address. What comes faster is refused. So many addresses are remembered.
REQUESTS, REQUEST_BURST, ADDRESSES = 40.0, 400, 1000
#: Connections at once, browsers with several pages included.
CONNECTIONS = 4 * PLAYERS
