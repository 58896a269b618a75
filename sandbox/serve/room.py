"""The room: who is there, what is played, who shot what. It passes messages on and asks the processes for computing."""

from __future__ import annotations

import asyncio
import secrets
from collections import deque
from collections.abc import Coroutine, Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from time import monotonic
from typing import Any, Literal, NamedTuple

from sandbox.errors import RequestError
from sandbox.serve import calls, messages
from sandbox.serve.connection import LATER, Connection
from sandbox.serve.limits import AWAY, DRAWN, HELLO, PLAYERS, REMEMBERED, ROWS, SENT
from sandbox.serve.processes import JobProcesses

Kind = Literal["scene", "preset", "task", "game"]


class Listed(NamedTuple):
    """Something that may be played here: its source as ``load`` takes it, a line about it, and whose it is."""

    source: str
    about: str
    kind: Kind = "scene"
    sport: str = ""  # the scene that it belongs to, as it is listed
    title: str = ""  # its name for people, "" for that by which it is listed
    game: str = ""  # of a game, by its name


class _Row(NamedTuple):
    """One shot in the teacher's table; ``ask`` plays it again."""

    number: int
    player: int
    name: str
    scene: str
    changes: Mapping[str, Any]
    verdict: str
    scored: bool
    facts: Mapping[str, float]
    fact: str  # that was predicted, "" for none
    predicted: float | None
    ask: calls.Ask


@dataclass(eq=False)
class _Pair:
    """Two players in one match, or one who waits for the second."""

    name: str  # of the game, as it is listed
    seed: int
    players: list[Player]
    outcomes: tuple[Mapping[str, Any], ...] = ()  # the facts of each shot
    scene: Mapping[str, Any] | None = None  # the description of the next shot; None while one waits

    def duel(self, game: str) -> calls.Duel:
        """The match so far, for a process that computes."""
        first, second = (player.name for player in self.players)
        return calls.Duel(game, (first, second), self.seed, self.outcomes)

    @property
    def player(self) -> Player | None:
        """The one whose turn it is; None while one waits, and at the end."""
        match = self.scene["match"] if self.scene is not None else {"over": True}
        return None if match["over"] else self.players[match["turn"]]


@dataclass(eq=False)
class Player:
    """One player, who may be away."""

    number: int
    session: str
    name: str
    source: str  # "" while the player chooses
    changes: dict[str, Any]
    connection: Connection | None = None
    seen: float = 0.0  # s, on the clock of monotonic: the last message, or when the player left
    shots: int = 0
    last: dict[str, Any] | None = None  # what the others see of the last shot
    tries: list[Mapping[str, Any]] = field(default_factory=list)  # in a task: what was set for each shot
    shooting: bool = False  # a shot is being computed
    pair: _Pair | None = None  # in a match


@dataclass(eq=False)
class _Lead:
    """The teacher's settings."""

    source: str = ""  # the scene for all; "" where everybody chooses
    changes: dict[str, Any] = field(default_factory=dict)
    frozen: bool = False
    predict: str = ""  # the result to be predicted; "" for none

    def as_message(self) -> dict[str, Any]:
        return {"source": self.source, "changes": self.changes, "frozen": self.frozen, "predict": self.predict}


class Room:
    """Everybody who plays on one server. ``scenes`` may be played, by the names that are shown."""

    def __init__(self, scenes: Mapping[str, Listed], processes: JobProcesses, units: str) -> None:
        self.scenes, self.processes, self.units = scenes, processes, units
        self.first = next(iter(scenes))
        self.players: dict[str, Player] = {}  # by session
        self.teachers: dict[Connection, str] = {}  # the scene that each looks at; "" for that of all
        self.lead = _Lead()
        self.rows: deque[_Row] = deque(maxlen=ROWS)
        self.small: dict[int, bytes] = {}  # pictures of shots, by their numbers
        self._drawn: dict[int, asyncio.Task[None]] = {}  # the making of others
        self.pairs: list[_Pair] = []  # matches
        self.counted = 0
        self.seed = secrets.randbelow(2**31)  # of tasks: the same starts for all
        self._numbered = 0
        self._described: dict[str, asyncio.Task[Mapping[str, Any]]] = {}
        self._tasks: set[asyncio.Task[None]] = set()

    # Scenes

    async def described(self, name: str) -> Mapping[str, Any]:
        """Return the description of a scene for the browser; computed once. Raises RequestError."""
        listed = self.scenes.get(name)
        if listed is None:
            raise RequestError("this scene is not played here")
        if name not in self._described:
            self._described[name] = asyncio.create_task(self._describe(name, listed))
        try:
            return await asyncio.shield(self._described[name])
        except RequestError:
            self._described.pop(name, None)
            raise

    async def _describe(self, name: str, listed: Listed) -> Mapping[str, Any]:
        is_task = listed.kind == "task"
        reply = await self.processes.compute("described", name, "described", calls.described, listed.source, is_task)
        return _description(reply)

    async def _described_for(self, player: Player) -> Mapping[str, Any]:
        """Return the description of what a player plays: in a match that of the next shot. Raises RequestError."""
        if player.pair is not None and player.pair.scene is not None:
            return player.pair.scene
        return await self.described(player.source)

    async def _checked(self, name: str, changes: Mapping[str, Any]) -> Mapping[str, Any]:
        """The description of a scene whose parameters may be changed so. Raises RequestError."""
        scene = await self.described(name)
        messages.check(changes, scene["by_key"])
        return scene

    def _listed(self) -> list[tuple[str, str, Kind, str, str]]:
        """Name, a line, kind, sport and title of all that may be played."""
        return [
            (name, each.about, each.kind, each.sport or name, each.title or name) for name, each in self.scenes.items()
        ]

    # A player

    async def play(self, connection: Connection) -> None:
        """Follow a player's connection to its end."""
        player = None
        try:
            while (text := await connection.receive(None if player else HELLO)) is not None:
                try:
                    message = messages.read(text)
                    if player is None:
                        player = await self._enter(connection, message)
                        if player is None:
                            return
                    else:
                        await self._do(player, connection, message)
                except RequestError as error:
                    connection.tell(str(error))
        finally:
            if player is not None and player.connection is connection:
                self._leave(player)

    async def _enter(self, connection: Connection, message: Any) -> Player | None:
        """The player who says hello: a new one, or one who comes back; None if the room is full."""
        if not isinstance(message, messages.Hello):
            raise RequestError("message refused: hello comes first")
        self._forget()
        player = self.players.get(message.session)
        if player is None:
            if sum(each.connection is not None for each in self.players.values()) >= PLAYERS:
                await connection.close(LATER, f"the room is full: {PLAYERS} players")
                return None
            self._numbered += 1
            called = messages.named(message.name) or f"player {self._numbered}"
            one = len({each.sport or name for name, each in self.scenes.items()}) == 1
            first = self.first if one else ""  # or he chooses
            player = Player(self._numbered, secrets.token_urlsafe(12), called, first, {})
            self.players[player.session] = player
        elif player.connection is not None:
            self._replace(player.connection)
        player.connection, player.seen = connection, monotonic()
        if message.name:
            player.name = messages.named(message.name) or player.name
        asked = (message.source, message.changes) if message.source else (player.source, player.changes)
        if self.lead.source and self.lead.source != asked[0]:
            asked = self.lead.source, self.lead.changes
        connection.send("welcome", {"session": player.session, "number": player.number, "name": player.name,
                                    "scenes": self._listed()})  # fmt: skip
        connection.send("lead", self.lead.as_message())
        if player.pair is not None and asked[0] == player.source:
            self._show_match(player.pair)
        elif asked[0]:
            await self._open_asked(player, *asked)
        self._tell_teachers()
        return player

    async def _open_asked(self, player: Player, name: str, changes: Mapping[str, Any]) -> None:
        """Let a player play what a link asks for; where that cannot be, such as in one of another version, the scene
        itself, or else what is played here."""
        connection = player.connection
        default = self.lead.source or self.first, self.lead.changes
        tried: list[tuple[str, Mapping[str, Any]]] = [(name, changes)]
        tried += [(name, {})] if name in self.scenes else []
        for source, wanted in (*tried, default):
            try:
                await self._open(player, source, wanted, again=source == player.source)
                return
            except RequestError as error:
                if connection is not None:
                    connection.tell(str(error))

    def _replace(self, connection: Connection) -> None:
        """Close the connection of a player who has come back by another."""
        self._follow(connection.close(LATER, "opened in another window"))

    def _leave(self, player: Player) -> None:
        player.connection, player.seen = None, monotonic()
        self.processes.forget(player.session)
        if player.pair is not None:
            self._show_match(player.pair)
        asyncio.get_running_loop().call_later(AWAY, self._tell_teachers)
        self._tell_teachers()

    def _forget(self) -> None:
        """Forget those who left long ago, and the first of those who left if they are too many."""
        now = monotonic()
        away = sorted((each for each in self.players.values() if each.connection is None), key=lambda each: each.seen)
        for player in away:
            if now - player.seen > REMEMBERED or len(self.players) >= 4 * PLAYERS:
                self._leave_match(player)
                del self.players[player.session]

    async def _open(self, player: Player, name: str, changes: Mapping[str, Any], again: bool = False) -> None:
        """Let a player play a scene, or a task from its first attempt, unless he plays it ``again``; or a game, with
        whoever waits for a second player. Raises RequestError."""
        pair = player.pair
        if pair is not None and pair.name == name and pair.scene is not None and pair.player is None:
            pair.players.reverse()  # once more: the other begins
            pair.outcomes = ()
            await self._next_shot(pair)
            return
        self._leave_match(player)
        if name in self.scenes and self.scenes[name].kind == "game":
            await self._join_match(player, name)
            return
        changes = messages.in_units(changes, (await self.described(name))["by_key"])
        scene = await self._checked(name, changes)
        if not again:
            player.tries = []
        player.source, player.changes = name, changes
        if player.connection is not None:
            player.connection.send("scene", _scene_message(name, player.changes, scene))

    async def _do(self, player: Player, connection: Connection, message: Any) -> None:
        """Do what a player asks for. Raises RequestError."""
        player.seen = monotonic()
        match message:
            case messages.Name():
                player.name = messages.named(message.name) or player.name
                connection.send("name", {"name": player.name})
                self._tell_teachers()
            case messages.Play():
                if self.lead.source and message.source != self.lead.source:
                    raise RequestError("the teacher has chosen what is played")
                if message.source:
                    await self._open(player, message.source, message.changes)
                else:
                    self._leave_match(player)
                    player.source, player.changes = "", {}
                self._tell_teachers()
            case messages.Aim() | messages.Shoot():
                messages.check(message.changes, (await self._described_for(player))["by_key"])
                if not self._only_shows(player, message):
                    self._check_turn(player)
                player.changes = dict(message.changes)
                if isinstance(message, messages.Shoot):
                    if player.shooting:
                        raise RequestError("the shot before is still being computed")
                    player.shooting = True
                    self._compute(player, "shot", message, self._shot_done(player, message))
                elif not self.lead.predict or message.do == "stage":
                    self._compute(player, message.do, message, None)
                elif message.do == "path":
                    self._compute(player, "hidden", message, None)
            case _:
                raise RequestError("message refused: hello was said already")

    def _check_turn(self, player: Player) -> None:
        """Raise RequestError unless a player may aim and shoot now."""
        if self.lead.frozen:
            raise RequestError("the teacher has stopped the game for a moment")
        if player.pair is not None and player.pair.player is not player:
            raise RequestError("it is not your turn")

    # Two in one match

    async def _join_match(self, player: Player, name: str) -> None:
        """Let a player play with whoever waits for a second one, or wait. Raises RequestError."""
        waiting = (each for each in self.pairs if each.name == name and len(each.players) == 1)
        pair = next((each for each in waiting if each.players[0].connection is not None), None)
        if pair is None:
            pair = _Pair(name, secrets.randbelow(2**31), [])
            self.pairs.append(pair)
        pair.players.append(player)
        player.pair, player.source, player.changes, player.tries = pair, name, {}, []
        if len(pair.players) == 2:
            await self._next_shot(pair)
        else:
            self._show_match(pair)

    async def _next_shot(self, pair: _Pair) -> None:
        """Show both players of a match its next shot. Raises RequestError."""
        listed, number = self.scenes[pair.name], len(pair.outcomes)
        asked = calls.described, listed.source, False, pair.duel(listed.game)
        reply = await self.processes.compute(pair, "described", "described", *asked)
        if number == len(pair.outcomes) and len(pair.players) == 2:
            pair.scene = _description(reply)
            for player in pair.players:
                player.changes = {}
            self._show_match(pair)

    def _show_match(self, pair: _Pair) -> None:
        """Tell both players of a match, or the one who waits, where it stands."""
        for place, player in enumerate(pair.players):
            if player.connection is None:
                continue
            other = next((each for each in pair.players if each is not player), None)
            there = other is not None and other.connection is not None
            if pair.scene is None:
                title = self.scenes[pair.name].title
                player.connection.send("waits", {"source": pair.name, "title": title})
            else:
                scene = _scene_message(pair.name, player.changes, pair.scene)
                shots = len(pair.outcomes)
                player.connection.send("scene", scene | {"you": place, "there": there, "shots": shots})

    def _leave_match(self, player: Player) -> None:
        """Take a player out of a match, which ends it for the other."""
        pair, player.pair = player.pair, None
        if pair is None:
            return
        self.pairs.remove(pair)
        for other in pair.players:
            if other is not player:
                other.pair, other.source = None, ""
                if other.connection is not None:
                    other.connection.send("left", {"text": f"{player.name} has left the match."})

    def _only_shows(self, player: Player, message: Any) -> bool:
        """True for a question that changes nothing, such as that of a page which was opened again."""
        aims = isinstance(message, messages.Aim)
        return aims and (message.do == "stage" or (message.do == "path" and message.changes == player.changes))

    def _compute(self, player: Player, kind: calls.Kind, message: Any, done: Any) -> None:
        """Have something computed for a player, and sent; ``done`` is called with what the server keeps of it."""
        self._follow(self._computed(player, kind, message, done))

    def _follow(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def _ask(self, name: str, changes: Mapping[str, Any], message: Any, game: calls.Game | calls.Duel) -> calls.Ask:
        """Return the question for a process that computes; where ``name`` is a scene, without the ``game``."""
        listed = self.scenes[name]
        in_game = game if listed.kind in ("task", "game") else None
        return calls.Ask(listed.source, changes, message.n, message.room, self.units, in_game)

    def _game_of(self, player: Player) -> calls.Game | calls.Duel:
        """The task or match of a player so far."""
        if player.pair is not None:
            return player.pair.duel(self.scenes[player.pair.name].game)
        return calls.Game(self.seed, player.number, tuple(player.tries))

    async def _computed(self, player: Player, kind: calls.Kind, message: Any, done: Any) -> None:
        source, changes, tries, pair = player.source, dict(message.changes), player.tries, player.pair
        setting = _unaimed(await self._described_for(player), changes)
        if kind == "stage" and self.lead.predict:  # where the picture ends would tell where the shot does
            changes = setting
        ask = self._ask(source, changes, message, self._game_of(player))
        alike = kind, source, frozenset(setting.items())
        reply = await self.processes.compute(player.session, kind, alike, calls.computed, kind, ask)
        if kind == "shot":
            player.shooting = False
            if reply is not None and "error" not in reply:
                tries.append(changes)  # a new game has a new list
        if reply is None or player.pair is not pair:
            return
        if "error" in reply:
            if player.connection is not None:
                player.connection.tell(reply["error"], message.n)
            return
        both = pair is not None and kind == "shot"
        for each in pair.players if pair is not None and both else [player]:
            if each.connection is not None and each.source == source:
                each.connection.send("path" if kind == "hidden" else kind, reply["message"])
        if done is not None:
            done(source, reply["kept"], ask)
        if pair is not None and both:
            pair.outcomes = (*pair.outcomes, reply["kept"]["outcome"])
            await self._next_shot(pair)

    def _shot_done(self, player: Player, message: messages.Shoot) -> Any:
        """Return the function that puts a computed shot into the teacher's table."""
        fact = self.lead.predict

        def done(source: str, kept: Mapping[str, Any], ask: calls.Ask) -> None:
            self.counted += 1
            player.shots += 1
            seen = {key: kept.get(key) for key in ("line", "scored", "verdict", "task")}
            player.last = {**seen, "source": source}
            predicted = message.predicted if fact else None
            self.rows.append(_Row(self.counted, player.number, player.name, source, dict(message.changes),
                                 kept["verdict"], kept["scored"], kept["facts"], fact, predicted, ask))  # fmt: skip
            self._tell_teachers()

        return done

    # The teacher

    async def teach(self, connection: Connection) -> None:
        """Follow a teacher's connection to its end."""
        self.teachers[connection] = ""
        try:
            while (text := await connection.receive()) is not None:
                try:
                    await self._taught(connection, messages.read(text, teacher=True))
                except RequestError as error:
                    connection.tell(str(error))
        finally:
            del self.teachers[connection]
            self.processes.forget(connection)

    async def _taught(self, connection: Connection, message: Any) -> None:
        """Do what a teacher asks for. Raises RequestError."""
        lead = self.lead
        match message:
            case messages.Hello():
                connection.send("welcome", {"scenes": self._listed()})
                await self._show(connection)
            case messages.Aim():
                source = self._watched_scene(connection)
                scene = await self._checked(source, message.changes)
                ask = self._ask(source, message.changes, message, calls.Game(self.seed, 0))
                alike = message.do, source, frozenset(_unaimed(scene, message.changes).items())
                await self._answer(connection, message.do, alike, ask)
                return
            case messages.Present():
                row = next((row for row in self.rows if row.number == message.number), None)
                if row is None:
                    raise RequestError("this shot is not in the table any more")
                ask = row.ask._replace(n=message.n, room=message.room)
                for kind in ("stage", "shot"):
                    await self._answer(connection, kind, (kind, row.scene), ask)
                return
            case messages.Look():
                self._tell_teachers()
                return
            case messages.Lead():
                if message.source:
                    await self._checked(message.source, message.changes)
                self.lead = _Lead(message.source, dict(message.changes), lead.frozen, "")
                self.seed = secrets.randbelow(2**31)
                for player in list(self.players.values()):
                    if message.source:
                        player.last = None
                        await self._open(player, message.source, message.changes)
                self.teachers = dict.fromkeys(self.teachers, "")
                for teacher in list(self.teachers):
                    await self._show(teacher)
            case messages.See():
                await self.described(message.source)
                self.teachers[connection] = message.source
                await self._show(connection)
                return
            case messages.Freeze():
                lead.frozen = message.on
            case messages.Predict():
                facts = (await self.described(lead.source or self.first))["facts"]
                if message.fact and message.fact not in [fact["key"] for fact in facts]:
                    raise RequestError("this result cannot be predicted")
                lead.predict = message.fact
            case messages.Clear():
                self.rows.clear()
                self.small.clear()
                for player in self.players.values():
                    player.last = None
        for player in self.players.values():
            if player.connection is not None:
                player.connection.send("lead", self.lead.as_message())
        self._tell_teachers()

    async def _answer(self, teacher: Connection, kind: calls.Kind, alike: Hashable, ask: calls.Ask) -> None:
        """Have something computed for a teacher, and send it."""
        reply = await self.processes.compute(teacher, kind, alike, calls.computed, kind, ask)
        if reply is not None and "error" in reply:
            teacher.tell(reply["error"])
        elif reply is not None:
            teacher.send(kind, reply["message"])

    async def small_picture(self, number: int) -> bytes | None:
        """A small picture of a shot of the table, drawn once; None where there is none, or none yet: a browser has few
        connections, which must not all wait."""
        if number not in self.small and number not in self._drawn:
            self._drawn[number] = asyncio.create_task(self._draw(number))
        if number in self._drawn:
            await asyncio.wait([self._drawn[number]], timeout=DRAWN)
        return self.small.get(number)

    async def _draw(self, number: int) -> None:
        """Have the small picture of a shot drawn, if it is still in the table."""
        row = next((row for row in self.rows if row.number == number), None)
        if row is not None:
            reply = await self.processes.compute("small", number, ("small", row.scene), calls.small, row.ask)
            if reply is not None and "message" in reply:
                self.small[number] = reply["message"]
                while len(self.small) > ROWS:
                    del self.small[next(iter(self.small))]
        del self._drawn[number]

    def _watched_scene(self, teacher: Connection) -> str:
        """The scene that a teacher looks at."""
        return self.teachers.get(teacher) or self.lead.source or self.first

    async def _show(self, teacher: Connection) -> None:
        """Tell a teacher which scene is shown."""
        source = self._watched_scene(teacher)
        changes = self.lead.changes if source == (self.lead.source or self.first) else {}
        teacher.send("scene", _scene_message(source, changes, await self.described(source)))

    def _tell_teachers(self) -> None:
        """Tell the teachers what has changed: who is there, or left a moment ago, and all shots."""
        if not self.teachers:
            return
        now = monotonic()
        players = [
            {"number": each.number, "name": each.name, "here": each.connection is not None, "shots": each.shots,
             "source": each.source, "last": each.last, "quiet": round(now - each.seen)}
            for each in self.players.values()
            if each.connection is not None or now - each.seen < AWAY
        ]  # fmt: skip
        rows = [{key: value for key, value in row._asdict().items() if key != "ask"} for row in self.rows]
        for teacher in self.teachers:
            teacher.send("room", {"lead": self.lead.as_message(), "players": players, "rows": rows[-SENT:],
                                  "counted": len(self.rows)})  # fmt: skip

    def table(self) -> tuple[Sequence[str], list[list[Any]]]:
        """Columns and rows of all shots: parameters that were changed and results, by their keys."""
        keys = list(dict.fromkeys(key for row in self.rows for key in row.changes))
        facts = list(dict.fromkeys(key for row in self.rows for key in row.facts))
        head = ["shot", "player", "name", "scene", *keys, "verdict", "scored", *facts, "predicted_result", "predicted"]
        return head, [
            [row.number, row.player, row.name, row.scene, *(row.changes.get(key, "") for key in keys), row.verdict,
             row.scored, *(row.facts.get(key, "") for key in facts), row.fact,
             "" if row.predicted is None else row.predicted]
            for row in self.rows
        ]  # fmt: skip


def _description(reply: calls.Reply | None) -> Mapping[str, Any]:
    """Return the description in a reply, with its parameters by key. Raises RequestError."""
    if reply is None or "error" in reply:
        raise RequestError(reply["error"] if reply else "this scene could not be loaded")
    kept = reply["kept"]
    return {**kept, "by_key": {each["key"]: each for each in kept["parameters"]}}


def _unaimed(scene: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return the changes without those of a pull: shots of one setting take about as long."""
    pull = scene["pull"] or {}
    return {key: value for key, value in changes.items() if key not in (pull.get("speed"), pull.get("angle"))}


def _scene_message(name: str, changes: Mapping[str, Any], scene: Mapping[str, Any]) -> dict[str, Any]:
    """Return the message that shows a scene with changes: its description, as the browser needs it."""
    return {"source": name, "changes": changes, **{key: value for key, value in scene.items() if key != "by_key"}}
