EXPECTED = {}


def cases(work, rtl):
    return []
