"""Tiles of servers that fail, lie and end sessions: the reaction to each; no secret gets out."""

import gzip
import json
import logging
import shutil
import socket
import threading
import time
import traceback
from email.utils import formatdate

import pytest
from firetwin.errors import InputError
from firetwin.tiles import cut, policies
from firetwin.tiles.loader import Loader
from firetwin.tiles.policies import Policy, google, openstreetmap
from firetwin.tiles.policies import ion as ion_policy
from firetwin.tiles.sources import MissingError, address, backoff, connection, ion, open_source, secret
from firetwin.tiles.sources.http import Http
from firetwin.tiles.sources.network import Network
from lying_server import Clock, Reply, serving
from tile_views import HERE, looking, names
from tilesets import GLB, as_bytes, box, tile, tileset

SECRET, SESSION = "k3y-of-somebody", "s3ssion-one"
FRESH = {"Cache-Control": "private, max-age=3600", "ETag": '"1"'}
WITH_SESSION = Policy("imitation", key_parameter="key", session_parameter="session")


@pytest.fixture
def server():
    with serving() as each:
        yield each


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def opened(server, clock, tmp_path):
    """Open the server's tileset: opened(path, **network)."""
    sources = []

    def make(path="/t/tileset.json", policy=None, **network):
        network = {"cache": tmp_path / "cache"} | network
        source = Http(server.url + path, Network(**network), clock, policy=policy)
        sources.append(source)
        return source

    yield make
    for each in sources:
        each.close()


def two_children(server, **replies):
    """A root with two children that replace it."""
    below = [tile(1.0, "a.glb", volume=box(50.0)), tile(1.0, "b.glb", volume=box(60.0))]
    root = tile(30.0, "r.glb", below, volume=box(50.0, half=20.0), refine="REPLACE")
    server.answers |= {"/t/tileset.json": as_bytes(tileset(root))}
    server.answers |= {f"/t/{each}.glb": GLB for each in "rab"} | {
        f"/t/{k}.glb": v for k, v in replies.items()
    }


def chosen(source):
    loader = Loader(source)
    return loader, cut.select_tiles(loader, looking(0.0), HERE, 2.0)


@pytest.mark.parametrize("status", [404, 410])
def test_the_nearest_ancestor_stands_in_for_what_is_gone(server, opened, clock, status):
    two_children(server, b=Reply(status, b"gone"))
    loader, choice = chosen(opened())
    assert names(loader, choice) == ["r.glb"]
    (why,) = choice.missing.values()
    assert why == f"{server.url}/t/b.glb: is not there (status {status})"
    assert clock.slept == []
    assert server.asked.count("/t/b.glb") == 1


def session_server(server, alive):
    """A service whose tiles want the key and a session that is alive; its root hands out sessions."""
    handed = iter(["s3ssion-one", "s3ssion-two", "s3ssion-three"])

    def root(query, _):
        if query.get("key") != SECRET:
            return Reply(403, b"bad key " + query.get("key", "").encode())
        below = tile(1.0, f"/t/a.glb?session={next(handed)}", volume=box(50.0))
        made = tile(30.0, "/t/r.glb", [below], volume=box(50.0, half=20.0), refine="REPLACE")
        return Reply(200, as_bytes(tileset(made)), FRESH)

    def content(query, _):
        if query.get("key") != SECRET or query.get("session") not in alive:
            words = f"session {query.get('session')} of key {query.get('key')} is over"
            return Reply(alive[0] if isinstance(alive[0], int) else 403, words.encode())
        return Reply(200, GLB, FRESH)

    server.answers |= {"/t/tileset.json": root, "/t/a.glb": content, "/t/r.glb": content}


@pytest.mark.parametrize("status", [400, 401, 403])
def test_a_session_that_has_ended_is_renewed_once_by_the_root(server, opened, status):
    session_server(server, [status, "s3ssion-two"])
    loader, choice = chosen(opened(f"/t/tileset.json?key={SECRET}", WITH_SESSION))
    assert names(loader, choice) == ["/t/a.glb?session=s3ssion-one"]
    assert not choice.missing
    roots = [each for each in server.asked if each.startswith("/t/tileset.json")]
    assert len(roots) == 2
    assert server.asked[-1] == f"/t/a.glb?key={SECRET}&session=s3ssion-two"


def test_the_second_time_it_stops_with_the_services_own_words(server, opened):
    session_server(server, ["none"])
    source = opened(f"/t/tileset.json?key={SECRET}", WITH_SESSION)
    with pytest.raises(
        InputError, match=r"is refused \(status 403: session \.\.\. of key \.\.\. is over\)"
    ) as caught:
        chosen(source)
    assert not isinstance(caught.value, MissingError)
    assert sum(each.startswith("/t/tileset.json") for each in server.asked) == 2


def test_a_wrong_key_is_said_with_the_services_words(server, opened):
    session_server(server, ["none"])
    with pytest.raises(
        InputError, match=r"is refused \(status 403: bad key \.\.\.\); check the key"
    ) as caught:
        Loader(opened("/t/tileset.json?key=wrong-key-12345", WITH_SESSION))
    assert "wrong-key" not in str(caught.value)


def test_a_file_that_an_open_server_refuses_is_missing(server, opened):
    two_children(server, b=Reply(403, b"<Error>AccessDenied</Error>"))
    loader, choice = chosen(opened())
    assert names(loader, choice) == ["r.glb"]
    assert "status 403: <Error>AccessDenied</Error>" in next(iter(choice.missing.values()))


@pytest.mark.parametrize("status", [408, 429, 500, 502, 503, 504])
def test_a_server_in_trouble_is_asked_again_later_and_later(server, opened, clock, status):
    two_children(server, a=[Reply(status), Reply(status), Reply(status), GLB])
    loader, choice = chosen(opened())
    assert names(loader, choice) == ["a.glb", "b.glb"]
    assert clock.slept == [0.5, 1.0, 2.0]


def test_after_five_repetitions_a_tile_is_missing_and_after_three_such_the_source_stops(
    server, opened, clock
):
    two_children(server, a=Reply(503, b"down"))
    loader, choice = chosen(opened())
    assert names(loader, choice) == ["r.glb"]
    assert server.asked.count("/t/a.glb") == 6
    assert "after 6 attempts (status 503: down)" in next(iter(choice.missing.values()))
    source = opened()
    source.parallel = 1
    server.answers |= {f"/t/{each}": Reply(503) for each in "xyz"}
    for each in "xy":
        with pytest.raises(MissingError):
            source.read(f"{server.url}/t/{each}")
    with pytest.raises(InputError, match="the server does not respond") as caught:
        source.read(f"{server.url}/t/z")
    assert not isinstance(caught.value, MissingError)


@pytest.mark.parametrize("as_date", [False, True])
def test_a_pause_that_the_server_asks_for_holds_for_the_whole_source(server, opened, clock, as_date):
    asked = formatdate(clock.time + 40, usegmt=True) if as_date else "40"
    server.answers |= {"/t/x": [Reply(429, headers={"Retry-After": asked}), b"x"], "/t/y": b"y"}
    source = opened()
    real, waited = source._backoff.extend, []
    source._backoff.extend = lambda seconds: (waited.append(seconds), real(seconds))
    assert source.read(f"{server.url}/t/x") == b"x"
    assert waited == [pytest.approx(40.0, abs=1.0)]
    source._backoff.extend(7.0)
    assert source.read(f"{server.url}/t/y") == b"y"  # another file waits too
    assert clock.slept[-1] == pytest.approx(7.0)


def test_a_pause_of_hours_stops_instead(server, opened):
    server.answers["/t/x"] = Reply(429, b"quota", {"Retry-After": "86400"})
    with pytest.raises(InputError, match=r"asks to wait 86,400 s \(status 429: quota\)"):
        opened().read(f"{server.url}/t/x")


def test_waits_double_with_chance_and_end_at_a_minute():
    clock = backoff.Clock(now=lambda: 0.0, jitter=lambda: 0.0)
    assert [backoff.retry_delay(None, each, clock) for each in (0, 1, 2, 20)] == [0.25, 0.5, 1.0, 30.0]
    assert backoff.retry_delay("nonsense", 0, clock) == 0.25


def test_a_server_that_is_silent_is_asked_again(server, opened, clock, monkeypatch):
    monkeypatch.setattr(connection, "TIMEOUT", 0.05)
    hold = threading.Event()

    def late(*_):
        if not hold.is_set():
            hold.set()
            time.sleep(0.15)
        return Reply(200, b"late")

    server.answers["/t/x"] = late
    assert opened().read(f"{server.url}/t/x") == b"late"
    assert clock.slept[0] == 0.5


def test_no_server_at_all_is_missing(opened, clock):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]
    source = opened()
    source.home = address.Origin("http", "127.0.0.1", port)
    with pytest.raises(MissingError, match="after 6 attempts"):
        source.read(f"http://127.0.0.1:{port}/t")
    assert len(clock.slept) == 5


SHORT = {
    "content-length": Reply(200, GLB[:6], length=12),
    "glb": GLB[:10],
    "b3dm": b"b3dm" + (1).to_bytes(4, "little") + (99).to_bytes(4, "little") + b"x" * 20,
    "subtree": b"subt" + (1).to_bytes(4, "little") + (9).to_bytes(8, "little") * 2,
    "gzip": Reply(200, gzip.compress(b"x" * 5000)[:-6], {"Content-Encoding": "gzip"}),
    "gzip-crc": Reply(200, gzip.compress(GLB)[:-8] + b"\0" * 8, {"Content-Encoding": "gzip"}),
}


@pytest.mark.parametrize("fault", SHORT)
def test_what_ends_early_is_asked_once_more_then_missing_and_never_cached(server, opened, tmp_path, fault):
    reply = SHORT[fault]
    if isinstance(reply, bytes):
        reply = Reply(200, reply)
    reply.headers = {**reply.headers, **FRESH}
    server.answers["/t/x.glb"] = reply
    source = opened()
    with pytest.raises(MissingError, match="ends early, twice"):
        source.read(f"{server.url}/t/x.glb")
    assert server.asked == ["/t/x.glb"] * 2
    assert not [
        path for path in (tmp_path / "cache").rglob("*") if path.is_file() and "answers" not in path.name
    ]
    server.answers["/t/x.glb"] = [reply, Reply(200, GLB)]
    assert source.read(f"{server.url}/t/x.glb") == GLB


def test_nothing_missing_is_silent(server, opened):
    two_children(server, a=Reply(404), b=Reply(404), r=Reply(404))
    _, choice = chosen(opened())
    assert choice.contents.tolist() == []
    assert choice.message().startswith("3 tiles are missing, the first: ")


@pytest.mark.parametrize("fault", ["changed", "cut", "gone", "no database"])
def test_a_damaged_cache_is_as_none(server, opened, tmp_path, fault):
    server.answers["/t/x"] = Reply(200, b"tile" * 100, FRESH)
    uri = f"{server.url}/t/x"
    opened().read(uri)
    (path,) = [p for p in (tmp_path / "cache").rglob("*") if p.is_file() and not p.name.startswith("answers")]
    if fault == "changed":
        path.write_bytes(b"evil" * 100)
    elif fault == "cut":
        path.write_bytes(b"tile")
    elif fault == "gone":
        path.unlink()
    else:
        for each in (tmp_path / "cache").glob("answers*"):
            each.unlink()
        (tmp_path / "cache/answers.db").write_bytes(b"not a database at all" * 100)
    for _ in range(3):
        assert opened().read(uri) == b"tile" * 100
    assert server.asked == ["/t/x"] * 2


def test_a_full_disk_keeps_nothing_and_goes_on(server, opened, monkeypatch):
    import errno

    from firetwin import files

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(files, "publish", full)
    server.answers["/t/x"] = Reply(200, b"tile", FRESH)
    for _ in range(2):
        assert opened().read(f"{server.url}/t/x") == b"tile"
    assert server.asked == ["/t/x"] * 2


def test_without_the_network_the_cache_answers_and_what_is_missing_is_listed(server, opened):
    two_children(server)
    for name in ("tileset.json", "r.glb", "a.glb"):
        body = server.answers[f"/t/{name}"]
        server.answers[f"/t/{name}"] = Reply(200, body, FRESH)
    server.answers["/t/b.glb"] = Reply(200, GLB, {"Cache-Control": "no-store"})
    chosen(opened())
    opened().read(f"{server.url}/t/r.glb")
    asked = len(server.asked)
    source = opened(online=False, setting="allow online access in Blender's preferences")
    loader, choice = chosen(source)
    assert names(loader, choice) == ["r.glb"]
    assert source.missing == [f"{server.url}/t/b.glb"]
    assert "allow online access in Blender's preferences" in next(iter(choice.missing.values()))
    assert len(server.asked) == asked
    with pytest.raises(
        InputError, match="is not in the cache, and the network may not be used: allow online"
    ):
        Loader(opened("/other.json", online=False, setting="allow online access"))


@pytest.mark.parametrize(
    ("reference", "message"),
    [
        ("https://elsewhere.example/a.glb", "another host than http://127.0.0.1.*--host elsewhere.example"),
        ("//elsewhere.example/a.glb", "plain http"),
        ("http://elsewhere.example/a.glb", "plain http"),
        ("http://127.0.0.1:9/a.glb", "another host"),
        ("file:///etc/passwd", "file: is not read from a server"),
        ("ftp://127.0.0.1/a", "ftp: is not"),
        ("data:application/octet-stream;base64,AAAA", "data: is not"),
        ("https://user:word@elsewhere.example/a", "user name"),
        ("http://[::1", "refers to an invalid URL"),
    ],
)
def test_a_tileset_stays_on_its_host(server, opened, reference, message):
    server.answers["/t/tileset.json"] = as_bytes(tileset(tile(1.0, reference, volume=box(50.0))))
    with pytest.raises(InputError, match=rf"^{server.url}/t/tileset\.json: .*{message}"):
        chosen(opened())
    assert server.asked == ["/t/tileset.json"]


def test_a_host_that_the_user_names_is_allowed(opened):
    source = opened(f"/t/tileset.json?key={SECRET}", WITH_SESSION, hosts=("tiles.example",))
    source.bearer = "t0ken"
    assert source.resolve(source.root, "https://tiles.example/a.glb") == "https://tiles.example/a.glb"
    url, headers = source._with_secrets("https://tiles.example/a.glb", "session", {})
    assert (url, headers) == ("https://tiles.example/a.glb", {})
    url, headers = source._with_secrets(f"{source.home}/a.glb", "of-now", {})
    assert url == f"{source.home}/a.glb?key={SECRET}&session=of-now"
    assert headers == {"Authorization": "Bearer t0ken"}


@pytest.mark.parametrize(
    "target", ["https://elsewhere.example/t/a.glb", "http://127.0.0.1:1/a.glb", "file:///etc/hosts"]
)
def test_redirects_to_another_host_are_refused(server, opened, target):
    two_children(server, a=Reply(302, headers={"Location": target + f"?token={SECRET}"}))
    with pytest.raises(InputError, match=r"is redirected to|is not read from a server") as caught:
        chosen(opened())
    assert SECRET not in str(caught.value)


def test_redirects_within_the_host_are_followed_a_few_times(server, opened):
    two_children(server, a=Reply(302, headers={"Location": "b.glb"}))
    loader, choice = chosen(opened())
    assert names(loader, choice) == ["a.glb", "b.glb"]
    server.answers["/t/a.glb"] = Reply(301, headers={"Location": "a.glb"})
    with pytest.raises(MissingError, match="more than 5 times"):
        opened(cache=None).read(f"{server.url}/t/a.glb")


@pytest.mark.parametrize(
    "url", ["http://tiles.example/t.json", "ftp://tiles.example/t.json", "https://a:b@tiles.example/"]
)
def test_refused_roots(url):
    with pytest.raises(InputError, match=r"plain http|is not read|user name"):
        Http(url, Network(cache=None))


@pytest.mark.parametrize(
    "numbers",
    [
        "10.1.2.3",
        "192.168.0.9",
        "169.254.169.254",
        "127.0.0.1",
        "::1",
        "fe80::1",
        "fd00::5",
        "::ffff:10.0.0.1",
        "0.0.0.0",
        "100.64.0.1",
        "224.0.0.1",
    ],
)
def test_a_public_name_with_a_private_address_is_refused(monkeypatch, numbers, clock):
    family = socket.AF_INET6 if ":" in numbers else socket.AF_INET
    found = [(family, socket.SOCK_STREAM, 6, "", (numbers, 443))]
    monkeypatch.setattr(socket, "getaddrinfo", lambda *_, **__: found)
    monkeypatch.setattr(socket.socket, "connect", lambda *_: pytest.fail("asked it"))
    source = Http("https://tiles.example/t.json", Network(cache=None), clock)
    with pytest.raises(InputError, match=r"tiles\.example: has the address .*, which is not public"):
        source.read(source.root)


def test_private_networks_are_allowed_if_asked_for_but_never_this_machine():
    guard = address.Guard(private=True)
    guard._check("tiles.example", "192.168.0.9")
    guard._check("localhost", "127.0.0.1")
    for each in ("127.0.0.1", "::1"):
        with pytest.raises(InputError, match="not public"):
            guard._check("tiles.example", each)
    address.Guard(private=False)._check("tiles.example", "93.184.215.14")


@pytest.mark.skipif(not shutil.which("openssl"), reason="needs openssl")
def test_certificates_are_verified(monkeypatch, clock, tmp_path):
    """A server with a self-signed certificate."""
    import ssl
    import subprocess

    key, certificate = tmp_path / "key.pem", tmp_path / "certificate.pem"
    command = "openssl req -x509 -newkey rsa:2048 -nodes -days 1 -subj /CN=localhost"
    made = subprocess.run([*command.split(), "-keyout", key, "-out", certificate], capture_output=True)
    if made.returncode:
        pytest.skip("openssl is not there")
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(certificate, key)
    with serving() as server:
        server._server.socket = context.wrap_socket(server._server.socket, server_side=True)
        source = Http(server.url.replace("http:", "https:"), Network(cache=None), clock)
        with pytest.raises(InputError, match="certificate cannot be verified"):
            source.read(source.root)
    assert connection._tls().verify_mode == ssl.CERT_REQUIRED
    assert connection._tls().check_hostname


def test_sizes_and_growth_are_limited(server, opened, clock):
    packed = gzip.compress(b"0" * 8_000_000)
    server.answers |= {
        "/t/large": Reply(200, b"x" * 2000),
        "/t/bomb": Reply(200, packed, {"Content-Encoding": "gzip"}),
        "/t/inner": Reply(200, packed),
        "/t/odd": Reply(200, b"x", {"Content-Encoding": "br"}),
    }
    source = opened(cache=None)
    with pytest.raises(InputError, match="is larger than 1,000 bytes"):
        source.read(f"{server.url}/t/large", 1000)
    with pytest.raises(InputError, match="grows more than 64 times"):
        source.read(f"{server.url}/t/bomb")
    with pytest.raises(InputError, match="grows to more than"):
        source.read(f"{server.url}/t/inner")
    with pytest.raises(MissingError, match="content encoding 'br'"):
        source.read(f"{server.url}/t/odd")
    server.answers["/t/fine"] = Reply(200, gzip.compress(GLB), {"Content-Encoding": "gzip"})
    assert source.read(f"{server.url}/t/fine") == GLB
    assert clock.slept == []  # the rest of an answer is not read as the next answer


def test_no_secret_is_in_logs_messages_keys_and_files(server, opened, tmp_path, caplog):
    session_server(server, [403, "s3ssion-two"])
    caplog.set_level(logging.DEBUG)
    source = opened(f"/t/tileset.json?key={SECRET}", WITH_SESSION)
    loader, _ = chosen(source)
    server.answers["/t/r.glb"] = Reply(500, f"key={SECRET} session=s3ssion-two".encode())
    texts = [source.name(source.root), source.root, loader.content_uri(0)]
    for most in (5, 10_000):
        try:
            source._failures = 5
            source.read(f"{server.url}/t/r.glb", most)
        except InputError as error:
            texts += [str(error), "".join(traceback.format_exception(error))]
    assert len(texts) == 7
    assert "GET /t/a.glb" in caplog.text
    texts.append(caplog.text)
    for path in (tmp_path / "cache").rglob("*"):
        texts.append(str(path))
        if path.is_file() and "answers" in path.name:
            texts.append(path.read_bytes().decode("latin-1"))
    for text in texts:
        assert SECRET not in text
        assert "s3ssion" not in text


def test_another_session_finds_what_one_has_cached(server, opened):
    """The key of the cache leaves out key and session."""
    session_server(server, [403, "s3ssion-one", "s3ssion-two"])
    chosen(opened(f"/t/tileset.json?key={SECRET}", WITH_SESSION))
    chosen(opened(f"/t/tileset.json?key={SECRET}", WITH_SESSION))
    assert sum(each.startswith("/t/a.glb") for each in server.asked) == 1
    assert (
        sum(each.startswith("/t/tileset.json") for each in server.asked) == 2
    )  # sessions come from the root


def test_redaction():
    redactor = secret.Redactor()
    redactor.add("abc/def+1", "no")
    for text, wanted in (
        ("GET /x?a=1&Key=AIza123&b=2", "GET /x?a=1&Key=...&b=2"),
        ("it says abc/def+1 twice: abc%2Fdef%2B1", "it says ... twice: ..."),
        ('{"accessToken": "eyJhbGc"}', '{"accessToken": "eyJhbGc"}'),
        ('{"token": "eyJhbGc"}', '{"token": "..."}'),
        ("Authorization: Bearer eyJhbGc.x", "Authorization: ... ..."),
        ("no secret", "no secret"),
    ):
        assert redactor.text(text) == wanted
    assert secret.split("https://a.example/x?v=1&session=q#f") == (
        "https://a.example/x?v=1",
        {"session": "q"},
    )
    assert secret.with_secrets("https://a.example/x?v=1", {"key": "a b"}) == "https://a.example/x?v=1&key=a+b"


def test_policies_are_data_without_keys(monkeypatch):
    assert {each.name for each in policies.known()} == {
        google.POLICY.name,
        ion_policy.POLICY.name,
        openstreetmap.POLICY.name,
    }
    assert policies.for_host("tile.googleapis.com") is google.POLICY
    assert policies.for_host("assets.ion.cesium.com") is ion_policy.POLICY
    assert policies.for_host("nottile.googleapis.com.example") is policies.OPEN
    assert not any((google.POLICY.may_flatten, google.POLICY.may_analyse, google.POLICY.may_work_offline))
    assert not any((google.POLICY.may_export, google.POLICY.may_pack, google.POLICY.other_geocoder))
    monkeypatch.delenv("GOOGLE_MAPS_API_KEY", raising=False)
    url = "https://tile.googleapis.com/v1/3dtiles/root.json"
    with pytest.raises(InputError, match="set the environment variable GOOGLE_MAPS_API_KEY"):
        Http(url, Network(cache=None))
    monkeypatch.setenv("GOOGLE_MAPS_API_KEY", SECRET)
    source = Http(url, Network(cache=None))
    assert source.root == url
    assert source._with_secrets(url, "", {})[0] == f"{url}?key={SECRET}"


def test_what_must_not_be_used_offline_is_not(server, opened):
    forbids = Policy("imitation", may_work_offline=False)
    server.answers["/t/x"] = Reply(200, b"x", {"Cache-Control": "max-age=0"})
    assert opened(policy=forbids).read(f"{server.url}/t/x") == b"x"
    with pytest.raises(MissingError, match="must not be used without the server"):
        opened(policy=forbids, online=False).read(f"{server.url}/t/x")
    assert opened(online=False).read(f"{server.url}/t/x") == b"x"


def test_a_policy_may_forbid_the_cache(server, opened, tmp_path):
    server.answers["/t/x"] = Reply(200, b"x", FRESH)
    for _ in range(2):
        opened(policy=Policy("imitation", may_store=False)).read(f"{server.url}/t/x")
    assert len(server.asked) == 2
    assert not (tmp_path / "cache").exists()


def ion_server(server, tokens):
    def endpoint(_, headers):
        if headers["Authorization"] != f"Bearer {SECRET}":
            return Reply(401, b'{"code": "InvalidCredentials"}')
        answer = {"type": "3DTILES", "url": f"{server.url}/t/tileset.json", "accessToken": next(tokens)}
        return Reply(200, json.dumps(answer).encode())

    server.answers["/v1/assets/7/endpoint"] = endpoint


def test_an_asset_of_ion_hands_out_its_url_and_a_token_that_is_renewed(server, clock, monkeypatch, tmp_path):
    tokens = iter(["t0ken-one", "t0ken-two"])
    ion_server(server, tokens)
    two_children(server)
    body = server.answers["/t/b.glb"]
    server.answers["/t/b.glb"] = lambda _, headers: (
        Reply(200, body) if headers["Authorization"] == "Bearer t0ken-two" else Reply(401, b"expired")
    )
    network = Network(cache=tmp_path / "cache")
    monkeypatch.delenv("CESIUM_ION_TOKEN", raising=False)
    with pytest.raises(InputError, match="set the environment variable CESIUM_ION_TOKEN"):
        open_source("ion:7", network)
    monkeypatch.setenv("CESIUM_ION_TOKEN", "wrong-token")
    with pytest.raises(InputError, match=r"is refused .status 401") as caught:
        ion.open_asset("ion:7", network, clock, server.url)
    assert "wrong-token" not in str(caught.value)
    monkeypatch.setenv("CESIUM_ION_TOKEN", SECRET)
    source = ion.open_asset("ion:7", network, clock, server.url)
    loader, choice = chosen(source)
    assert names(loader, choice) == ["a.glb", "b.glb"]
    assert source.policy is ion_policy.POLICY
    with pytest.raises(InputError, match="the number of an asset"):
        open_source("ion:my-city", network)
    source.close()


def test_an_asset_may_lead_to_another_service(server, clock, monkeypatch):
    url = f"https://tile.googleapis.com/v1/3dtiles/root.json?key={SECRET}"
    answer = {"externalType": "3DTILES", "options": {"url": url}}
    server.answers["/v1/assets/9/endpoint"] = json.dumps(answer).encode()
    monkeypatch.setenv("CESIUM_ION_TOKEN", "any-token")
    source = ion.open_asset("ion:9", Network(cache=None), clock, server.url)
    assert source.policy is google.POLICY
    assert SECRET not in source.root


def test_every_request_has_our_name_and_no_cookie(server, opened):
    server.answers["/t/x"] = Reply(200, b"x", {"Set-Cookie": "a=b"})
    source = opened(cache=None)
    source.read(f"{server.url}/t/x")
    source.read(f"{server.url}/t/x")
    assert server.headers[-1]["User-Agent"].startswith("Firetwin/")
    assert "Cookie" not in server.headers[-1]
    assert Network().cache.name == "tiles"
