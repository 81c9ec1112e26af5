"""The strongest adversary that we can make against the certificate: `twin-bench stability --attack`."""
