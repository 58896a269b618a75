"""A folder of posters and pages with an index."""

from pathlib import Path

from sandbox.page.gallery import build


def test_the_index_leads_to_posters_and_pages(browser, tmp_path: Path):
    index = build(tmp_path / "gallery", ["throws", "volleyball"])
    browser.resize(1280, 900)
    browser.driver.get(index.as_uri())
    assert browser.text("h2") == ["throws", "volleyball"]
    assert browser.run("[...document.images].every((image) => image.naturalWidth === 1280)")
    assert browser.run("[...document.images].every((image) => Math.abs(image.width / image.height - 16 / 9) < 0.02)")
    browser.run("document.querySelector('a').click()")
    assert "throws.html" in browser.driver.current_url
    assert browser.driver.get_log("browser") == []
