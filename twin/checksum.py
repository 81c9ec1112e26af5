"""SHA-256 without OpenSSL: the standard library's own code does it, and the loop's process keeps 1 MB that
libcrypto would take for a few digests at its start."""

try:
    from _sha2 import sha256  # Python 3.12 and later
except ImportError:
    try:
        from _sha256 import sha256
    except ImportError:  # another Python: OpenSSL's then
        from hashlib import sha256


def sha256_hex(data: bytes) -> str:
    """The SHA-256 of these bytes, 64 hexadecimal digits."""
    digest: str = sha256(data).hexdigest()
    return digest
