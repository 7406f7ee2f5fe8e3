"""Names that would turn texts round."""

from tractionpower.reporting.facts.characters import unturned


def test_only_what_turns_texts_is_replaced():
    signs = {chr(k) for k in range(0x2000, 0x2070) if unturned(chr(k)) != chr(k)}
    assert signs == {*map(chr, range(0x202A, 0x202F)), *map(chr, range(0x2066, 0x206A))}
    assert unturned("Kraków 🚆 \u05d0") == "Kraków 🚆 \u05d0"
