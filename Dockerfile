# syntax=docker/dockerfile:1
# For linux/arm64 and linux/amd64; the stages are the README's steps.
#   docker build --target on-board -t shiptwin .
#   docker buildx build --platform linux/arm64,linux/amd64 --target on-board -t shiptwin .
FROM python:3.11-slim-bookworm AS base
ENV PYTHONUNBUFFERED=1 PIP_NO_CACHE_DIR=1 PIP_DISABLE_PIP_VERSION_CHECK=1 ORT_DISABLE_TELEMETRY=1

# build: the package and what it needs on board, in one environment
FROM base AS build
WORKDIR /src
COPY pyproject.toml README.md LICENSE ./
COPY twin twin
COPY export export
COPY bench bench
COPY deploy/requirements.lock deploy/
RUN python -m venv /opt/shiptwin && /opt/shiptwin/bin/pip install --require-hashes -r deploy/requirements.lock && /opt/shiptwin/bin/pip install --no-deps .

# on-board: no extras, no compiler, no root; listens on loopback unless twin.toml says otherwise
FROM base AS on-board
RUN useradd --system --create-home --home-dir /var/lib/shiptwin shiptwin && install -d -o shiptwin /var/log/shiptwin
COPY --from=build /opt/shiptwin /opt/shiptwin
COPY deploy/twin.toml /etc/shiptwin/twin.toml
ENV PATH=/opt/shiptwin/bin:$PATH
USER shiptwin
WORKDIR /var/lib/shiptwin
VOLUME /var/log/shiptwin
HEALTHCHECK --interval=30s --timeout=15s --start-period=10s CMD ["twin", "health", "--config", "/etc/shiptwin/twin.toml"]
STOPSIGNAL SIGTERM
ENTRYPOINT ["twin"]
CMD ["run", "--config", "/etc/shiptwin/twin.toml"]

# study: the same with what the work ashore needs
FROM build AS study
RUN /opt/shiptwin/bin/pip install '.[study]'
ENV PATH=/opt/shiptwin/bin:$PATH
WORKDIR /work
ENTRYPOINT ["twin"]

# test: the README's second command
FROM base AS test
RUN apt-get update && apt-get install -y --no-install-recommends chromium make openssl systemd valgrind && rm -rf /var/lib/apt/lists/*
WORKDIR /src
COPY . .
RUN make test
