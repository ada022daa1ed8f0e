from pathlib import Path

import pytest

from ros_lint.base.tree import DiskTree, MachineTree, MemoryTree, OverlayTree

FILES = {"a/package.xml": "<package/>", "a/src/x.cpp": b"\xff", "b.txt": "", "a.b/c": "c"}


def on_disk(folder: Path) -> DiskTree:
    for path, content in FILES.items():
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content if isinstance(content, bytes) else content.encode())
    return DiskTree(str(folder))


def test_a_memory_tree_behaves_like_a_disk_tree(tmp_path: Path) -> None:
    disk, memory = on_disk(tmp_path), MemoryTree(FILES)
    for folder in ("", "a", "a/src", "a.b"):
        assert disk.list(folder) == memory.list(folder)
    for path in FILES:
        assert disk.read(path) == memory.read(path)
        assert disk.stamp(path).size == memory.stamp(path).size
    for tree in (disk, memory):
        with pytest.raises(OSError, match="nothing"):
            tree.read("nothing")
        with pytest.raises(OSError, match="b.txt"):
            tree.list("b.txt")


def test_large_files_are_read_completely(tmp_path: Path) -> None:
    for size in (0, 1, 65535, 65536, 65537, 131072, 3_000_000):
        (tmp_path / "f").write_bytes(bytes(range(256)) * (size // 256) + b"x" * (size % 256))
        assert DiskTree(str(tmp_path)).read("f") == (tmp_path / "f").read_bytes()


@pytest.mark.parametrize("path", ["a\0b", "\ud800"])
@pytest.mark.parametrize("tree", [DiskTree("/"), MachineTree()])
def test_a_path_that_no_file_can_have_does_not_exist(tree: DiskTree, path: str) -> None:
    for use in (tree.list, tree.read, tree.stamp, tree.identity):
        with pytest.raises(FileNotFoundError):
            use(path)


def test_links_are_followed_and_broken_links_are_of_another_kind(tmp_path: Path) -> None:
    (tmp_path / "d").mkdir()
    (tmp_path / "d" / "up").symlink_to(tmp_path)
    (tmp_path / "itself").symlink_to(tmp_path / "itself")
    (tmp_path / "broken").symlink_to("nowhere")
    tree = DiskTree(str(tmp_path))
    assert [(entry.name, entry.kind, entry.link) for entry in tree.list("")] == [
        ("broken", "other", True),
        ("d", "directory", False),
        ("itself", "other", True),
    ]
    assert tree.identity("") == tree.identity("d/up")


def test_an_overlay_changes_content_only() -> None:
    below = MemoryTree(FILES)
    tree = OverlayTree(below, {"b.txt": b"new"})
    assert tree.read("b.txt") == b"new"
    assert tree.read("a/src/x.cpp") == b"\xff"
    assert tree.list("") == below.list("")


def test_an_overlay_can_add_files() -> None:
    tree = OverlayTree(MemoryTree(FILES), {"a/new.txt": b"new"})
    assert [entry.name for entry in tree.list("a")] == sorted(["new.txt", *(e.name for e in MemoryTree(FILES).list("a"))])
    assert tree.read("a/new.txt") == b"new"
    assert tree.stamp("a/new.txt").size == 3
    with pytest.raises(FileNotFoundError):
        tree.stamp("a/other.txt")
